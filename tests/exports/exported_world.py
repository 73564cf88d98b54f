"""A world in Python with a mask: a walk on a ring of twelve places, where a step back is allowed on even ones only."""


class Box:
    shape = (3,)


class Discrete:
    n = 3


class World:
    observation_space = Box()
    action_space = Discrete()
    without_chance = True

    def _observe(self):
        return [self._place / 12, self._steps / 40, 1]

    def action_mask(self):
        return [1, 1, self._place % 2 == 0]

    def reset(self, seed=None):
        self._place, self._steps = seed % 12, 0
        return self._observe(), {}

    def step(self, action):
        self._place = (self._place + (0, 1, -1)[action]) % 12
        self._steps += 1
        return self._observe(), float(self._place == 6), False, self._steps == 40, {}
