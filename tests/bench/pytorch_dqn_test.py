"""The peer of a training in PyTorch: its world, its update and its flights beside Fresco's, and the script that compares
the two trainings. Runs in fresco-bench-python."""
import importlib.util
import itertools
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

if importlib.util.find_spec("torch") is None:
    print("skipped: PyTorch is not installed (apt-get install --no-install-recommends python3-torch)")
    sys.exit(77)

import fresco_experiment
import numpy as np
import torch

import pytorch_dqn

FOLDER = pathlib.Path(__file__).resolve().parent
URL = "udpm://239.255.76.67:7885?ttl=0"
SMALL = """scenario {
  grid { columns: 5 rows: 5 } slots: 14 start { column: 0 row: 0 } stop { column: 4 row: 4 }
  sensor { x_m: 0 y_m: 100 } sensor { x_m: 75 y_m: 25 } coverage_radius_m: 30
}
agent { hidden_layers: [32, 32] safe_action_mask: true coverage_mask: true batch_size: 32 flown_return_bound: true
  linear { initial: 3e-3 final: 1e-4 } target_update_period: 50 }
schedule { episodes: 3000 inserts_per_update: 4 minimum_replay_size: 100 window: 8 updates_per_version: 50
  versions_per_evaluation: 1 ladder { exponent: 3 } excursion_share: 0.3 }
"""
MOVES = ["north", "south", "east", "west", "hover"]


class World(unittest.TestCase):
    def test_flies_the_golden_episode(self):
        experiment = fresco_experiment.Experiment("quick")
        environments = fresco_experiment.Environments(experiment, 2)
        environments.reset([1])  # the second one does not fly
        masks, rewards = environments.masks, environments.rewards
        text = (FOLDER.parent / "worlds" / "golden" / "table_one.txt").read_text()
        slots = re.findall(r"^ +\d+  \(.*\d  ([.NSEWH]{5})  ([.\d]{3}) +(\d+) +(\d+) +(\d+)  +(?:arrived|(\w+) (\d) +(\S+))$",
                           text, re.MULTILINE)
        self.assertEqual(len(slots), 70)
        total_aoi = 0
        for safe, covered, *aoi, move, sensor, reward in slots:
            total_aoi += sum(map(int, aoi))
            if not move:
                break
            allowed = [letter != "." and (number == 0 or covered[number - 1] != ".")
                       for letter in safe for number in range(4)]
            np.testing.assert_array_equal(masks[0], allowed)
            action = experiment.action_names.index(move if sensor == "0" else f"{move}, sensor {sensor}")
            environments.step(np.array([action, 0]))
            self.assertAlmostEqual(rewards[0], float(reward), 5)
        self.assertEqual(list(environments.endings), [1, 0])
        self.assertEqual(environments.figures(1)[0, 1], total_aoi)
        self.assertEqual(environments.successes(1), [True])

    def test_says_what_is_wrong(self):
        with self.assertRaisesRegex(RuntimeError, "quikc.*did you mean quick"):
            fresco_experiment.Experiment("quikc")
        with self.assertRaisesRegex(RuntimeError, "batch_size"):
            fresco_experiment.Experiment("quick", ["agent.batch_size=0"])


class Peer(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="fresco-test-")
        self.addCleanup(folder.cleanup)
        self.config = pathlib.Path(folder.name) / "small.textproto"
        self.config.write_text(SMALL)

    def experiment(self, *settings):
        return fresco_experiment.Experiment(str(self.config), settings)

    def check_updates(self, experiment, way):
        inputs, actions = experiment.layer_sizes[0], experiment.layer_sizes[-1]
        columns, batch = pytorch_dqn.Columns(inputs, actions), experiment.agent.batch_size
        peer, learner = pytorch_dqn.Dqn(experiment, way), fresco_experiment.LearnerUpdate(experiment)
        generator = np.random.default_rng(1)
        for update in range(20):
            rows = generator.random((batch, columns.width), np.float32)
            terminal = generator.random(batch) < 0.2
            masks = generator.random((batch, actions)) < 0.5
            masks[:, 3] = True
            rows[:, columns.action] = generator.integers(actions, size=batch)
            rows[:, columns.discount] = np.where(terminal, 0, experiment.agent.discount)
            rows[:, columns.least][update % 2::2] = -np.inf
            rows[:, columns.forbidden] = np.where(masks, 0, -np.inf)
            rate = 1e-3 / (1 + update)
            loss = learner.update(
                rows[:, columns.observation].copy(), rows[:, columns.action].astype(np.int16),
                rows[:, columns.reward].copy(), rows[:, columns.next_observation].copy(), rows[:, columns.discount].copy(), masks,
                rows[:, columns.least].copy(), rate)
            self.assertAlmostEqual(peer.update(torch.from_numpy(rows), rate).item() / loss, 1, 4)
            if update % 8 == 7:
                peer.copy_to_target()
                learner.copy_to_target()
        flown = [array for layer in learner.layers for array in layer]
        for ours, theirs in zip(flown, peer.parameters, strict=True):
            np.testing.assert_allclose(theirs.detach().numpy(), ours, rtol=0, atol=2e-5)

    def test_updates_the_networks_as_fresco_does(self):
        for way, double_dqn in zip(pytorch_dqn.WAYS, itertools.cycle(("true", "false", "false", "true"))):
            with self.subTest(way=way, double_dqn=double_dqn):
                self.check_updates(self.experiment(f"agent.double_dqn={double_dqn}", "agent.discount=0.9"), way)

    def test_flies_a_window_of_episodes_that_can_be_flown_again(self):
        experiment = self.experiment()
        training = pytorch_dqn.Training(experiment, next(iter(pytorch_dqn.WAYS)))
        columns = training.columns
        episodes = training.fly_window()
        self.assertEqual([len(rows) for rows in episodes], [13] * 8)
        again = fresco_experiment.Environments(experiment, 8)
        again.reset([1] * 8)
        stack = np.stack(episodes)
        for slot in range(13):
            now = stack[:, slot]
            np.testing.assert_array_equal(now[:, columns.observation], again.observations)
            actions = now[:, columns.action].astype(int)
            self.assertTrue(again.masks[range(8), actions].all())
            again.step(actions)
            np.testing.assert_array_equal(now[:, columns.next_observation], again.observations)
            np.testing.assert_array_equal(now[:, columns.reward], again.rewards)
            np.testing.assert_array_equal(now[:, columns.forbidden] == 0, again.masks)
            np.testing.assert_array_equal(now[:, columns.discount], float(slot < 12))
            np.testing.assert_allclose(now[:, columns.least], stack[:, slot:, columns.reward].sum(1), atol=1e-5)

    def test_sets_out_for_random_places(self):
        experiment = self.experiment("schedule.excursion_share=1")
        environments = fresco_experiment.Environments(experiment, 50)
        environments.reset([1] * 50)
        explorer = pytorch_dqn.Explorer(experiment, environments, np.ones(50))
        generator = np.random.default_rng(1)
        values = np.zeros((50, 15))
        values[:, [2, 5, 8, 11]] = 1  # a move and the second sensor, which may not be covered
        places, given_up = set(), 0
        for _ in range(13):
            actions = explorer.choose(values, generator)
            self.assertTrue(environments.masks[range(50), actions].all())
            self.assertTrue(environments.masks_towards(explorer.places)[range(50), actions].all())
            places.update(explorer.places)
            given_up += (explorer.places < 0).sum()  # the way there would lead too far from the stop
            environments.step(actions)
        self.assertEqual(places, set(range(-1, 25)))
        self.assertTrue(0 < given_up < 13 * 50 / 2, given_up)
        self.assertTrue(all(environments.successes(50)))

    def test_overwrites_the_oldest_transitions(self):
        replay = pytorch_dqn.ReplayMemory(5, 1)
        for begin in (0, 3, 6):
            replay.insert(torch.arange(begin, begin + 3.0).unsqueeze(1))
        self.assertEqual(replay.rows.squeeze(1).tolist(), [5, 6, 7, 8, 4])
        self.assertEqual(set(replay.sample(200).squeeze(1).tolist()), {4, 5, 6, 7, 8})

    def compare(self, *arguments):
        done = subprocess.run([FOLDER / "time_to_optimum", "--config", self.config, "--seeds", "1", "--tune", "0",
                               "--lcm-url", URL, *arguments], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_both_come_near_the_optimum(self):
        self.assertRegex(self.compare("--within", "20", "--limit", "50"),
                         r"\| 1 \| [\d.]+ \| \d+ \| [\d.]+ \| [\d.]+ \| \d+ \| [\d.]+ \|\n(.*\n)*ratio of the medians: [\d.]+\n")

    def test_says_what_nobody_can_reach(self):
        self.assertRegex(self.compare("--within", "-1", "--limit", "0.5"),
                         r"\| 1 \| not within 0.5 s \|  \|  \| not within 0.5 s \|  \|  \|\n(.*\n)*no ratio")


if __name__ == "__main__":
    unittest.main()
