"""Worlds in Python that misbehave."""
import time
from types import SimpleNamespace as Space


class Sound:
    observation_space, action_space = Space(shape=(2,)), Space(n=3)
    observation_names, action_names = ["steps", "luck"], ["left", "stay", "right"]

    def reset(self, seed=None):
        self.steps, self.luck = 0, seed % 5
        return [self.steps, self.luck], {}

    def step(self, action):
        self.steps += 1
        return [[self.steps], [self.luck]], action, self.steps == 4 + self.luck, False, {}


class Masked(Sound):
    @property
    def action_mask(self):
        return [True, self.steps % 2 == 0, False]


class RaisesInReset(Sound):
    def reset(self, seed=None):
        raise ValueError("no start")


class RaisesInStep(Sound):
    def step(self, action):
        return super().step(action) if self.steps < 2 else {}["missing"]


class ReturnsNan(Sound):
    def step(self, action):
        return [float("nan"), 0], 0, False, False, {}


class ReturnsNanReward(Sound):
    def step(self, action):
        return [0, 0], float("nan"), False, False, {}


class ReturnsThree(Sound):
    def step(self, action):
        return [1, 2, 3], 0, False, False, {}


class ReturnsText(Sound):
    def step(self, action):
        return "state", 0, False, False, {}


class ReturnsFour(Sound):
    def step(self, action):
        return [1, 2], 0, False, {}


class Sleeps(Sound):
    def step(self, action):
        time.sleep(3600)


class WithoutSpaces:
    pass


class NeedsArguments(Sound):
    def __init__(self, size):
        self.size = size


class WithFewNames(Sound):
    observation_names = ["steps"]
