"""The promises of the README in worlds whose episodes differ by their seeds: CartPole, in which these decide where
an episode begins, and the UAV's world with a new field in every episode."""
import csv
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import unittest

from fresco_process import ROOT, FrescoTest, url, wait_until

# A tiny training: episodes of 60 steps at most, evaluations of five episodes.
CARTPOLE = """cartpole { maximum_steps: 60 }
agent { hidden_layers: [16] double_dqn: true batch_size: 16 replay_capacity: 2000 target_update_period: 50
  linear { initial: 5e-3 final: 1e-4 } }
schedule { episodes: 400 inserts_per_update: 4 minimum_replay_size: 200 window: 8 updates_per_version: 20
  versions_per_evaluation: 5 evaluation_episodes: 5 ladder { base: 0.3 exponent: 3 } }
"""
# Few sensors over a small grid, all of it drawn. Half of the orders search.
FIELDS = """scenario { grid { columns: 6 rows: 6 } slots: 16 start { column: 0 row: 0 } stop { column: 3 row: 5 }
  random_sensors { per_episode: true minimum: 1 maximum: 3 }
  random_field { coverage_radius_m { minimum: 25 maximum: 50 } slots { minimum: 12 maximum: 16 } any_start: true
    weight { minimum: 0.5 maximum: 2 } } }
agent { set_network { encoder_layers: [16] trunk_layers: [16] head_layers: [16] } batch_size: 32 replay_capacity: 5000
  target_update_period: 50 safe_action_mask: true coverage_mask: true flown_return_bound: true n_step: 3 discount: 0.95
  linear { initial: 5e-3 final: 1e-4 } }
schedule { episodes: 600 inserts_per_update: 4 minimum_replay_size: 200 window: 8 updates_per_version: 50
  versions_per_evaluation: 10 evaluation_episodes: 10 excursion_share: 0.3 ladder { base: 0.3 exponent: 3 }
  search { width: 4 } }
"""
# One of these fields.
FIELD = FIELDS.replace("random_sensors { per_episode: true minimum: 1 maximum: 3 }",
                       "sensor { x_m: 10 y_m: 110 } sensor { x_m: 100 y_m: 30 weight: 2 } }").split("  random_field")[0] + (
                           "agent" + FIELDS.split("agent")[1].replace("evaluation_episodes: 10", ""))
# The same over a map, which is a picture beside the configuration.
TOWN = FIELDS.replace("grid { columns: 6 rows: 6 }", 'map: "town.png"').replace(
    "start { column: 0 row: 0 } stop { column: 3 row: 5 }", "")
TOWN_TEXT = """....SS
.BB.N.
.BB.N.
......
.RRR..
SS....
"""
LONGER = ("--set", "schedule.episodes=4000")
COLUMNS = ["utime", "run_id", "order_index", "actor_id", "seed", "transition", "ending", "position", "velocity", "angle",
           "angular_velocity", "action", "action_name", "reward", "td_error", "next_position", "next_velocity",
           "next_angle", "next_angular_velocity", "next_allowed_actions"]


class Worlds(FrescoTest):
    def setUp(self):
        super().setUp()
        self.config = self.folder / "cartpole.textproto"
        self.config.write_text(CARTPOLE)

    def train_cartpole(self, port, name, *arguments):
        return self.train(port, name, *arguments, config=self.config)

    def expect_same(self, summary, other):
        for key in ("weights_crc32c", "transitions", "updates", "return", "success", "best_version", "config_hash"):
            self.assertEqual(summary[key], other[key], key)

    def test_gives_the_same_weights_with_any_number_of_actors(self):
        one = self.train_cartpole(17661, "one", "--actors", 1)
        four = self.train_cartpole(17661, "four", "--actors", 4)
        self.expect_same(four, one)
        self.assertEqual(one["episodes"], 400)
        self.assertNotEqual(self.train_cartpole(17661, "seed-2", "--seed", 2)["weights_crc32c"], one["weights_crc32c"])
        # All of a world without an optimum and without baselines.
        self.assertEqual(one["world"], {"name": "cartpole", "success": "balanced",
                                        "figures": [{"name": "return", "unit": ""}]})
        self.assertEqual((one["score"], one["evaluation_episodes"]), (one["return"], 5))
        self.assertEqual(one["balanced"], one["success"] == 1)
        for key in one:
            self.assertNotRegex(key, "aoi|optim|baseline|gap|bound|arrived")

    def assert_log_has_the_weights_of(self, one):
        """Retrains from the log of the run "four", and returns its path."""
        log = self.folder / "four" / "traffic.lcm"
        again = json.loads(self.run_fresco("retrain", log, "--strict", "--out", self.folder / "again", "--format",
                                           "json")[0])
        self.assertEqual(again["weights_crc32c"], one["weights_crc32c"])
        return log

    def test_gives_the_same_weights_if_every_episode_has_a_field_of_its_own(self):
        path = self.folder / "fields.textproto"
        path.write_text(FIELDS)
        one = self.train(17666, "one", "--actors", 1, config=path)
        four = self.train(17666, "four", "--actors", 4, "--record", config=path)
        for key in ("weights_crc32c", "transitions", "updates", "average_aoi", "success"):
            self.assertEqual(four[key], one[key], key)
        self.assertEqual(one["success"], 1)  # the mask keeps every stop within reach
        log = self.assert_log_has_the_weights_of(one)
        rows = list(csv.DictReader(self.run_fresco("log", "export", log)[0].splitlines()))
        self.assertLessEqual({row["slots"] for row in rows}, {"12", "13", "14", "15", "16"})
        self.assertGreater(len({(row["sensor_1_x_m"], row["sensor_1_y_m"]) for row in rows}), 500)
        figures = json.loads(self.run_fresco("evaluate", "--policy", self.folder / "one", "--episodes", 20, "--format",
                                             "json")[0])
        self.assertEqual(len({episode["total_aoi"] for episode in figures["episodes"]} - {None}) > 10, True)

        self.check_start_from(self.folder / "one")

    def check_start_from(self, general):
        """The training of one field begins with the network for many."""
        config = self.folder / "field.textproto"
        config.write_text(FIELD)
        start = ("--start-from", general)
        one = self.train(17667, "field-1", "--actors", 1, *start, config=config)
        three = self.train(17667, "field-3", "--actors", 3, "--record", *start, config=config)
        anew = self.train(17667, "anew", "--actors", 2, config=config)
        for key in ("weights_crc32c", "config_hash", "total_aoi"):
            self.assertEqual(three[key], one[key], key)
        self.assertNotEqual(anew["weights_crc32c"], one["weights_crc32c"])
        self.assertNotEqual(anew["config_hash"], one["config_hash"])
        log = self.folder / "field-3" / "traffic.lcm"
        _, errors = self.run_fresco("retrain", log, "--out", self.folder / "no", expect=2)
        self.assertRegex(errors, "agent.start_crc32c: expected the network .* found none; name it with --start-from")
        _, errors = self.run_fresco("retrain", log, "--start-from", self.folder / "anew", "--out", self.folder / "other",
                                    "--set", "schedule.episodes=20")
        again = json.loads(self.run_fresco("retrain", log, "--strict", *start, "--out", self.folder / "field-again",
                                           "--format", "json")[0])
        self.assertEqual(again["weights_crc32c"], one["weights_crc32c"])
        self.assertEqual(again["retrain"]["different_versions"], 0)
        # An interrupted run whose checkpoint is lost begins with the same network.
        (self.folder / "field-1" / "summary.json").unlink()
        shutil.rmtree(self.folder / "field-1" / "checkpoints", ignore_errors=True)
        resumed = json.loads(self.run_fresco("train", "--resume", self.folder / "field-1", "--format", "json")[0])
        self.assertEqual(resumed["weights_crc32c"], one["weights_crc32c"])
        # A network of another size, and a network that was replaced.
        _, errors = self.run_fresco("train", "--config", config, *start, "--set", "agent.set_network.head_layers=8",
                                    "--out", self.folder / "no", expect=2)
        self.assertRegex(errors, r"--start-from: expected a network with layers of .* \(agent.set_network\)")
        (self.folder / "field-1" / "summary.json").unlink()
        shutil.rmtree(self.folder / "field-1" / "checkpoints", ignore_errors=True)
        (self.folder / "field-1" / "start.network").write_bytes((self.folder / "anew" / "best.network").read_bytes())
        _, errors = self.run_fresco("train", "--resume", self.folder / "field-1", expect=2)
        self.assertRegex(errors, "start.network: expected the network with CRC-32C")

    def test_gives_the_same_weights_over_a_map(self):
        config = self.folder / "town.textproto"
        config.write_text(TOWN)
        (self.folder / "town.txt").write_text(TOWN_TEXT)
        subprocess.run([ROOT / "tools" / "map_picture", self.folder / "town.txt", self.folder / "town.png"], check=True)
        one = self.train(17663, "one", "--actors", 1, config=config)
        (self.folder / "town.png").unlink()  # the run has the map in its own configuration
        four = self.train(17663, "four", "--actors", 4, "--record", config=self.folder / "one" / "config.textproto")
        for key in ("weights_crc32c", "transitions", "updates", "average_aoi", "success", "config_hash"):
            self.assertEqual(four[key], one[key], key)
        self.assertEqual(one["success"], 1)  # the mask keeps every stop within reach
        log = self.assert_log_has_the_weights_of(one)
        obstacles = {(float(column), float(row)) for column, row in ((1, 3), (2, 3), (1, 4), (2, 4), (4, 3), (4, 4))}
        rows = list(csv.DictReader(self.run_fresco("log", "export", log)[0].splitlines()))
        self.assertFalse({(float(row["column"]), float(row["row"])) for row in rows} & obstacles)

    def test_gives_the_same_weights_however_often_the_learner_is_killed(self):
        often = (*LONGER, "--set", "run.checkpoint_interval_s=0.02")
        undisturbed = self.train_cartpole(17662, "undisturbed", *often)
        process = self.start("train", "--config", self.config, "--lcm-url", url(17662), "--out", self.folder / "killed",
                             "--format", "json", *often)
        for _ in range(3):
            before = self.checkpoints("killed")
            wait_until(lambda: self.checkpoints("killed") not in ([], before), "a further checkpoint")
            os.kill(self.learner_of("killed"), signal.SIGKILL)
            _, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 1, errors)
            self.assertIn("--resume", errors)
            process = self.start("train", "--resume", self.folder / "killed", "--format", "json")
        resumed = self.summary_of(process)
        self.expect_same(resumed, undisturbed)
        self.assertEqual(resumed["resumptions"], 3)
        for name in ("final.network", "best.network"):
            self.assertEqual((self.folder / "killed" / name).read_bytes(),
                             (self.folder / "undisturbed" / name).read_bytes(), name)

    def checkpoints(self, name):
        return sorted((self.folder / name / "checkpoints").glob("*.checkpoint"))

    def test_gives_the_same_weights_from_its_log_whose_rows_have_the_names_of_the_world(self):
        live = self.train_cartpole(17663, "live", "--actors", 2, "--record")
        log = self.folder / "live" / "traffic.lcm"
        output, _ = self.run_fresco("retrain", log, "--strict", "--out", self.folder / "again", "--format", "json")
        again = json.loads(output)
        self.expect_same(again, live)
        self.assertTrue(again["retrain"]["same_configuration"])
        self.assertEqual((again["retrain"]["flown_again"], again["retrain"]["different_versions"]), (0, 0))
        output, _ = self.run_fresco("retrain", log, "--set", "agent.hidden_layers=8", "--out", self.folder / "other",
                                    "--format", "json")
        other = json.loads(output)
        self.assertFalse(other["retrain"]["same_configuration"])
        self.assertEqual(other["transitions"], live["transitions"])  # the recorded experience
        self.run_fresco("retrain", log, "--set", "cartpole.maximum_steps=50", "--out", self.folder / "no", expect=2)
        self.check_rows(log, live)

    def check_rows(self, log, live):
        """A push for 0.02 s moves the cart by its velocity; that is CartPole-v1's Euler step."""
        table = list(csv.DictReader(self.run_fresco("log", "export", log)[0].splitlines()))
        self.assertEqual(list(table[0]), COLUMNS)
        self.assertGreaterEqual(len(table), live["transitions"])
        endings = {"none": 0, "terminal": 0, "truncated": 0}
        for row in table:
            self.assertEqual(row["action_name"], ("push left", "push right")[int(row["action"])])
            self.assertEqual((row["reward"], row["next_allowed_actions"]), ("1", "0 1"))
            for name, velocity in (("position", "velocity"), ("angle", "angular_velocity")):
                expected = float(row[name]) + 0.02 * float(row[velocity])
                self.assertTrue(math.isclose(float(row["next_" + name]), expected, abs_tol=1e-5), row)
            fallen = abs(float(row["next_position"])) > 2.4 or abs(float(row["next_angle"])) > 12 * 2 * math.pi / 360
            self.assertEqual(row["ending"] == "terminal", fallen, row)
            self.assertEqual(row["ending"] == "truncated", not fallen and int(row["transition"]) == 59, row)
            endings[row["ending"]] += 1
        self.assertGreater(min(endings.values()), 0, endings)

    def test_shows_its_figures_in_table_report_and_evaluation(self):
        output, _ = self.run_fresco("train", "--config", self.config, "--lcm-url", url(17664), "--out",
                                    self.folder / "run")
        self.assertRegex(output, r"\n  policy +return  balanced\n  this run \(DQN\) +\d+\.\d{3}  (yes|NO|\d+(\.\d+)? %)\n")
        page = (self.folder / "run" / "report.html").read_text()
        shown = page.split("</style>")[1].split("<section id=\"configuration\"")[0]
        for text in (output.split("\nlook at it")[0], shown):
            for word in ("AoI", "optimum", "gap", "flight"):
                self.assertNotIn(word, text)
        self.assertIn("<th scope=\"col\">balanced</th>", page)
        header, *rows = (self.folder / "run" / "metrics.csv").read_text().splitlines()
        self.assertTrue(header.endswith(",balanced,return"))
        self.assertGreater(len(rows), 3)
        self.check_evaluation()

    def check_evaluation(self):
        def evaluate(*arguments):
            return self.run_fresco("evaluate", "--policy", self.folder / "run", *arguments)[0]

        figures = json.loads(evaluate("--episodes", 20, "--seed", 3, "--format", "json"))
        returns = [episode["return"] for episode in figures["episodes"]]
        self.assertEqual(len(returns), 20)
        self.assertEqual(len({episode["seed"] for episode in figures["episodes"]}), 20)
        for episode in figures["episodes"]:
            self.assertEqual(episode["balanced"], episode["return"] == 60)
        self.assertAlmostEqual(figures["return"], sum(returns) / 20, places=9)
        self.assertAlmostEqual(figures["success"], returns.count(60) / 20, places=9)
        self.assertEqual(json.loads(evaluate("--episodes", 20, "--seed", 3, "--format", "json")), figures)
        other = json.loads(evaluate("--episodes", 20, "--seed", 4, "--format", "json"))
        self.assertNotEqual(other["episodes"], figures["episodes"])
        text = evaluate("--episodes", 20, "--seed", 3)
        self.assertIn(f"return {sum(returns) / 20:.3f} on average over 20 episodes, {min(returns):.3f} to {max(returns):.3f}",
                      text)
        self.assertRegex(text, r": \d+(\.\d+)? % balanced\n")
        self.assertIn("over 5 episodes", evaluate())  # schedule.evaluation_episodes

    def test_refuses_what_only_the_uavs_world_has(self):
        self.train_cartpole(17665, "run", "--set", "schedule.episodes=100")
        for command in ("fly", "evaluate"):
            _, errors = self.run_fresco(command, "--policy", "aoi", "--config", self.config, expect=2)
            self.assertIn("\"aoi\"", errors)
        _, errors = self.run_fresco("fly", "--policy", self.folder / "run", expect=2)
        self.assertIn("the world cartpole has no flights; only the UAV's world (scenario) has", errors)
        _, errors = self.run_fresco("train", "--set", "cartpole.maximum_steps=9", "--out", self.folder / "no", expect=2)
        self.assertIn("is scenario", errors)
        self.assertFalse((self.folder / "no").exists())


if __name__ == "__main__":
    sys.exit(unittest.main())
