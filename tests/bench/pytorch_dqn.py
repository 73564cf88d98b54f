#!/usr/bin/env python3
"""The peer of a whole training: a DQN in PyTorch, in one process, with the environments, the hyperparameters and the
algorithm of `fresco train`. It ends at the first evaluation that is near enough to the exact optimum and prints what it
took as JSON. Exit status: 0 it is near enough, 1 it is not, at the end of the training or of the time.

    build/release/bin/fresco-bench-python tests/bench/pytorch_dqn.py --config quick --set schedule.seed=2
    build/release/bin/fresco-bench-python tests/bench/pytorch_dqn.py --tune 2       # the fastest way to update

It is as fast as we can make it. A window of episodes is flown side by side, with one forward pass for all of them. The
replay memory is one tensor, a row for each transition, so that a sample is one copy. The numbers of threads and
OpenBLAS's kernels are the environment's (OMP_NUM_THREADS, OPENBLAS_NUM_THREADS, OPENBLAS_CORETYPE);
tests/bench/time_to_optimum looks for the best.
"""
import time

BEGIN_S = time.perf_counter()

import argparse
import itertools
import json
import sys

import fresco_experiment
import numpy as np
import torch

from pytorch_update import flatten, literal_adam, updates_per_s

TERMINAL, TRUNCATED = 1, 2  # Ending of worlds/world.h
WAYS = {f"Adam {adam}, {'scripted' if scripted else 'not scripted'}, oneDNN {'on' if onednn else 'off'}":
        (adam, scripted, onednn)
        for adam, scripted, onednn in itertools.product(("flat", "foreach"), (False, True), (False, True))}


class Columns:
    """Where each part of a transition is in its row: s, s', a, r, gamma (0 if s' is terminal), the least value of
    Q(s, a), and for each action 0 if it is allowed in s', else minus infinity."""

    def __init__(self, inputs, actions):
        self.observation = slice(0, inputs)
        self.next_observation = slice(inputs, 2 * inputs)
        self.action, self.reward, self.discount, self.least = range(2 * inputs, 2 * inputs + 4)
        self.forbidden = slice(2 * inputs + 4, 2 * inputs + 4 + actions)
        self.width = self.forbidden.stop


class ReplayMemory:
    """A ring of the latest transitions."""

    def __init__(self, capacity, width):
        self.rows = torch.zeros(capacity, width)
        self.inserted = 0

    def insert(self, rows):
        capacity = len(self.rows)
        begin = self.inserted % capacity
        first = min(len(rows), capacity - begin)
        self.rows[begin:begin + first] = rows[:first]
        self.rows[:len(rows) - first] = rows[first:]
        self.inserted += len(rows)

    def sample(self, count):
        held = min(self.inserted, len(self.rows))
        return self.rows.index_select(0, torch.randint(held, (count,)))


class Dqn:
    """The current and the target network, and one step of Adam for each batch."""

    def __init__(self, experiment, way):
        adam, scripted, onednn = WAYS[way]
        torch.backends.mkldnn.set_flags(onednn)
        self.agent = experiment.agent
        sizes = experiment.layer_sizes
        self.columns = Columns(sizes[0], sizes[-1])
        current, target = (self._network(experiment.initial_layers()) for _ in range(2))
        options = self.agent.adam
        if adam == "flat":
            self.flat, self.flat_target = flatten(current), flatten(target)
            self.step = literal_adam(self.flat, options.beta1, options.beta2, options.epsilon)
        else:
            self.flat = None
            self.optimizer = torch.optim.Adam(current.parameters(), betas=(options.beta1, options.beta2),
                                              eps=options.epsilon, foreach=True)
        self.parameters, self.target_parameters = list(current.parameters()), list(target.parameters())
        self.current = torch.jit.script(current) if scripted else current
        self.target = torch.jit.script(target) if scripted else target

    @staticmethod
    def _network(layers):
        modules = []
        for weights, biases in layers:
            linear = torch.nn.Linear(*reversed(weights.shape))
            linear.weight.data.copy_(torch.from_numpy(weights))
            linear.bias.data.copy_(torch.from_numpy(biases))
            modules += [linear, torch.nn.ReLU(inplace=True)]
        return torch.nn.Sequential(*modules[:-1])

    @torch.no_grad()
    def values(self, observations):
        """Q(s, a) of each row, for acting."""
        return self.current(torch.from_numpy(observations)).numpy()

    @torch.no_grad()
    def targets(self, rows):
        columns = self.columns
        next_observations, forbidden = rows[:, columns.next_observation], rows[:, columns.forbidden]
        values = self.target(next_observations)
        if self.agent.double_dqn:
            choices = self.current(next_observations).add_(forbidden).argmax(1, keepdim=True)
            later = values.gather(1, choices).squeeze(1)
        else:
            later = values.add_(forbidden).amax(1)
        return torch.addcmul(rows[:, columns.reward], rows[:, columns.discount], later).maximum(rows[:, columns.least])

    def update(self, rows, learning_rate):
        """Makes one step for a batch of transitions. Returns the loss before it."""
        targets = self.targets(rows)
        if self.flat is not None:
            self.flat.grad.zero_()
        else:
            self.optimizer.zero_grad(set_to_none=True)
        actions = rows[:, self.columns.action].long().unsqueeze(1)
        chosen = self.current(rows[:, self.columns.observation]).gather(1, actions).squeeze(1)
        loss = torch.nn.functional.mse_loss(chosen, targets)
        loss.backward()
        if self.flat is not None:
            self.step(learning_rate)
        else:
            self.optimizer.param_groups[0]["lr"] = learning_rate
            self.optimizer.step()
        return loss

    @torch.no_grad()
    def copy_to_target(self):
        if self.flat is not None:
            self.flat_target.copy_(self.flat)
        else:
            for target, current in zip(self.target_parameters, self.parameters):
                target.copy_(current)


def greedy(values, masks):
    return np.where(masks, values, -np.inf).argmax(1)


class Explorer:
    """Chooses the actions of a batch: epsilon-greedily, with excursions to random places if the experiment has them."""

    def __init__(self, experiment, environments, epsilons):
        self.experiment, self.environments, self.epsilons = experiment, environments, epsilons
        self.share = experiment.schedule.excursion_share
        self.places = np.full(len(environments.masks), -1, np.int32)  # negative: on no excursion

    def choose(self, values, generator):
        masks = allowed = self.environments.masks
        if self.share > 0:
            self.places[self.environments.are_at(self.places)] = -1
        explores = (self.places < 0) & (generator.random(len(masks)) < self.epsilons)
        if self.share > 0:
            sets_out = explores & (generator.random(len(masks)) < self.share)
            self.places[sets_out] = self.experiment.draw_places(generator.integers(2 ** 63), sets_out.sum())
            explores &= ~sets_out
            masks = self.environments.masks_towards(self.places)
            blocked = ~masks.any(1)
            self.places[blocked] = -1
            masks[blocked] = allowed[blocked]
        actions = greedy(values, masks)
        if explores.any():
            drawn = (generator.random(masks.shape) * allowed).argmax(1)
            actions = np.where(explores, drawn, actions)
        return actions


class Training:
    def __init__(self, experiment, way):
        self.experiment, self.schedule = experiment, experiment.schedule
        torch.manual_seed(self.schedule.seed)
        self.generator = np.random.default_rng(self.schedule.seed)
        self.dqn = Dqn(experiment, way)
        self.columns = self.dqn.columns
        self.replay = ReplayMemory(experiment.agent.replay_capacity, self.columns.width)
        window = min(self.schedule.window, self.schedule.episodes)
        self.environments = fresco_experiment.Environments(experiment, window)
        self.evaluated = fresco_experiment.Environments(experiment, self.schedule.evaluation_episodes)
        self.rows = np.zeros((window, experiment.longest_episode, self.columns.width), np.float32)
        self.updates = self.episodes = self.evaluations = 0

    def fly_window(self):
        """Flies the next episodes with the present network. Returns the rows of each."""
        experiment, environments, columns, rows = self.experiment, self.environments, self.columns, self.rows
        numbers = range(self.episodes, min(self.episodes + len(rows), self.schedule.episodes))
        environments.reset([experiment.episode_seed(number) for number in numbers])
        epsilons = np.zeros(len(rows))
        epsilons[:len(numbers)] = [experiment.epsilon(number, self.replay.inserted) for number in numbers]
        explorer = Explorer(experiment, environments, epsilons)
        lengths = np.zeros(len(rows), int)
        flying, slot = len(numbers), 0
        while flying:
            now = rows[:, slot]
            lengths += (environments.endings == 0)
            now[:, columns.observation] = environments.observations
            actions = explorer.choose(self.dqn.values(environments.observations), self.generator)
            flying = environments.step(actions)
            now[:, columns.next_observation] = environments.observations
            now[:, columns.action] = actions
            now[:, columns.reward] = environments.rewards
            now[:, columns.discount] = np.where(environments.endings == TERMINAL, 0, experiment.agent.discount)
            now[:, columns.forbidden] = np.where(environments.masks, 0, -np.inf)
            slot += 1
        self.set_least_values(rows[:, :slot])
        return [torch.from_numpy(rows[i, :lengths[i]]) for i in range(len(numbers))]

    def set_least_values(self, rows):
        """What the episode earned from each transition on is a lower bound of Q*, if the experiment says so."""
        rows[:, :, self.columns.least] = -np.inf
        if not self.experiment.agent.flown_return_bound:
            return
        complete = self.environments.endings != TRUNCATED
        earned = np.zeros(len(rows))
        for slot in reversed(range(rows.shape[1])):  # rewards after the end are 0
            earned = rows[:, slot, self.columns.reward] + self.experiment.agent.discount * earned
            rows[complete, slot, self.columns.least] = earned[complete]

    def commit(self, rows):
        """Inserts an episode's transitions and makes the updates that are due. Yields after each version to evaluate."""
        every, least = self.schedule.inserts_per_update, self.schedule.minimum_replay_size
        while len(rows):
            count = min(len(rows), every - self.replay.inserted % every)
            self.replay.insert(rows[:count])
            rows = rows[count:]
            if self.replay.inserted % every == 0 and self.replay.inserted >= least:
                rate = self.experiment.learning_rate(self.updates, self.episodes)
                self.dqn.update(self.replay.sample(self.experiment.agent.batch_size), rate)
                self.updates += 1
                if self.updates % self.experiment.agent.target_update_period == 0:
                    self.dqn.copy_to_target()
                if self.updates % (self.schedule.updates_per_version * self.schedule.versions_per_evaluation) == 0:
                    yield
        self.episodes += 1

    def evaluate(self):
        """The mean score of greedy episodes, and whether all of them succeeded."""
        environments, count = self.evaluated, self.schedule.evaluation_episodes
        environments.reset([self.experiment.evaluation_seed(self.evaluations + i) for i in range(count)])
        self.evaluations += count
        flying = count
        while flying:
            flying = environments.step(greedy(self.dqn.values(environments.observations), environments.masks))
        return environments.figures(count)[:, 0].mean(), all(environments.successes(count))

    def results(self):
        """Trains to the end; yields each evaluation."""
        while self.episodes < self.schedule.episodes:
            for rows in self.fly_window():
                for _ in self.commit(rows):
                    yield self.evaluate()
        yield self.evaluate()


def train(experiment, way, optimum, within_percent, limit_s, begin_s):
    training = Training(experiment, way)
    best = None
    for score, success in training.results():
        gap = fresco_experiment.gap_percent(score, optimum)
        if success and (best is None or gap < best["gap_percent"]):
            best = {"score": score, "gap_percent": gap}
        seconds = time.perf_counter() - begin_s
        reached = success and gap <= within_percent
        if reached or seconds > limit_s:
            break
    return {"reached": bool(reached), "seconds": seconds, "episodes": training.episodes, "updates": training.updates,
            **(best or {"score": None, "gap_percent": None})}


def tune(experiment, seconds):
    """Updates a second of every way, on a full replay memory of random transitions."""
    found = {}
    for way in WAYS:
        try:
            dqn = Dqn(experiment, way)
            replay = ReplayMemory(20_000, dqn.columns.width)
            rows = torch.rand(20_000, dqn.columns.width)
            rows[:, dqn.columns.action] = torch.randint(experiment.layer_sizes[-1], (20_000,)).float()
            rows[:, dqn.columns.forbidden][torch.rand(20_000, experiment.layer_sizes[-1]) < 0.5] = -torch.inf
            rows[:, dqn.columns.forbidden.start] = 0
            replay.insert(rows)
            update = lambda: dqn.update(replay.sample(experiment.agent.batch_size), 1e-4)
            for _ in range(5):
                update()
            found[way] = max(updates_per_s(update, seconds / 3) for _ in range(3))
        except (RuntimeError, TypeError):  # this version of PyTorch does not have it
            continue
    way = max(found, key=found.get)
    return {"way": way, "updates_per_s": found[way], "pytorch": torch.__version__}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--config", default="quick", help="a file or a ready experiment")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="a field of the experiment")
    parser.add_argument("--optimum", type=float, help="the optimal score; omitted: searched for, which takes time")
    parser.add_argument("--within", type=float, default=1, help="percent above the optimum that are near enough")
    parser.add_argument("--limit", type=float, default=900, help="seconds after which it gives up")
    parser.add_argument("--way", choices=WAYS, default=next(iter(WAYS)), help="how an update is made")
    parser.add_argument("--tune", type=float, metavar="SECONDS", help="only measure each way, for so long")
    arguments = parser.parse_args()
    torch.set_flush_denormal(True)
    experiment = fresco_experiment.Experiment(arguments.config, arguments.set)
    if arguments.tune:
        print(json.dumps(tune(experiment, arguments.tune)))
        return
    optimum = arguments.optimum or experiment.optimum()
    if optimum is None:
        sys.exit(f"{arguments.config}: nothing proves the optimum of its world")
    result = train(experiment, arguments.way, optimum, arguments.within, arguments.limit, BEGIN_S)
    print(json.dumps(result), flush=True)
    if not result["reached"]:
        sys.exit(f"no evaluation within {arguments.within:g} % of the optimum, {optimum:.6g}, after "
                 f"{result['seconds']:.0f} s and {result['episodes']} episodes")


if __name__ == "__main__":
    main()
