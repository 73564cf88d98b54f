"""CartPole in thirty lines, with Gymnasium's interface and nothing installed."""
import math
import random
from types import SimpleNamespace as Space


class CartPole:
    observation_space, action_space = Space(shape=(4,)), Space(n=2)

    def reset(self, seed=None):
        self.random = random.Random(seed)
        self.state = [self.random.uniform(-0.05, 0.05) for _ in range(4)]
        return self.state, {}

    def step(self, action):
        x, v, angle, spin = self.state
        force = 10.0 if action == 1 else -10.0
        push = (force + 0.05 * spin * spin * math.sin(angle)) / 1.1
        turn = (9.8 * math.sin(angle) - math.cos(angle) * push) / (0.5 * (4 / 3 - 0.1 * math.cos(angle) ** 2 / 1.1))
        pull = push - 0.05 * turn * math.cos(angle) / 1.1
        self.state = [x + 0.02 * v, v + 0.02 * pull, angle + 0.02 * spin, spin + 0.02 * turn]
        failed = abs(self.state[0]) > 2.4 or abs(self.state[2]) > 12 * math.pi / 180
        return self.state, 1.0, failed, False, {}


class StillPole(CartPole):
    """The same, and the pole always begins at the same angle."""
    without_chance = True

    def reset(self, seed=None):
        return super().reset(seed=1)
