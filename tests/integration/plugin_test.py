"""Worlds that are not Fresco's: the example plug-in, built by its own CMake file, and worlds in Python; what they are
worth (the same weights whatever happens) and what happens when their code fails."""
import json
import os
import pathlib
import signal
import subprocess
import unittest

from fresco_process import ROOT, FrescoTest, url, wait_until

PYTHON_WORLDS = ROOT / "tests" / "plugins" / "python"
SMALL_AGENT = """
agent { hidden_layers: [32] batch_size: 32 linear {} }
schedule {
  episodes: 150 inserts_per_update: 4 minimum_replay_size: 200 window: 8 updates_per_version: 20
  versions_per_evaluation: 10 evaluation_episodes: 5 ladder {}
}
"""
EXAMPLE = None


def setUpModule():
    """Builds the example as its users do."""
    global EXAMPLE
    build = pathlib.Path(os.environ["FRESCO_BUILD"]) / "example"
    for command in (["cmake", "-S", ROOT / "examples" / "plugin", "-B", build], ["cmake", "--build", build]):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    EXAMPLE = build / "libmountain_car.so"


class Plugin(FrescoTest):
    def config(self, world):
        path = self.folder / "world.textproto"
        path.write_text(world + SMALL_AGENT)
        return path

    def expect_the_same_weights_whatever_happens(self, port, config):
        one = self.train(port, "one", "--actors", 1, config=config)
        self.assertTrue(one["completed"])
        four = self.train(port, "four", "--actors", 4, "--record", config=config)
        self.assertEqual(four["weights_crc32c"], one["weights_crc32c"])
        self.assertEqual(four["score"], one["score"])
        output, _ = self.run_fresco("retrain", self.folder / "four" / "traffic.lcm", "--out", self.folder / "again",
                                    "--format", "json", "--strict")
        self.assertEqual(json.loads(output)["weights_crc32c"], one["weights_crc32c"])
        killed = self.start("train", "--config", config, "--lcm-url", url(port), "--out", self.folder / "killed",
                            "--set", "run.checkpoint_interval_s=0.05", "--format", "json")
        wait_until(lambda: list((self.folder / "killed").glob("checkpoints/*.checkpoint")), "a checkpoint")
        os.kill(self.learner_of("killed"), signal.SIGKILL)
        killed.communicate(timeout=60)
        self.assertEqual(killed.returncode, 1)
        output, _ = self.run_fresco("train", "--resume", self.folder / "killed", "--format", "json")
        resumed = json.loads(output)
        self.assertEqual(resumed["weights_crc32c"], one["weights_crc32c"])
        self.assertEqual(resumed["resumptions"], 1)
        return one

    def test_the_example_trains_to_the_same_weights(self):
        summary = self.expect_the_same_weights_whatever_happens(
            17761, self.config(f'plugin {{ library: "{EXAMPLE}" }}'))
        self.assertEqual(summary["world"]["name"], "mountain_car")
        for key in ("optimal_average_aoi", "gap_percent", "baselines", "optimum_search"):
            self.assertNotIn(key, summary)

    def test_a_world_in_python_trains_to_the_same_weights(self):
        summary = self.expect_the_same_weights_whatever_happens(17762, self.config(
            f'python {{ object: "pole:CartPole" path: "{PYTHON_WORLDS}" success_return: 100 }}'))
        self.assertEqual(summary["world"]["name"], "cartpole")

    def test_the_check_finds_what_is_not_repeatable(self):
        output, _ = self.run_fresco("check", "--library", EXAMPLE, program="fresco-world")
        self.assertIn("every episode was the same when played again", output)
        faulty = pathlib.Path(os.environ["FRESCO_BUILD"]) / "tests" / "plugins" / "faulty_world.so"
        output, errors = self.run_fresco("check", "--library", faulty, "--settings", "a clock", program="fresco-world",
                                         expect=1)
        self.assertIn("DIFFERENT when played again", output)
        self.assertIn("not functions of their seed and actions", errors)
        for settings, status in (("no chance", 0), ("hidden chance", 1)):
            _, errors = self.run_fresco("check", "--library", faulty, "--settings", settings, program="fresco-world",
                                        expect=status)
            self.assertEqual("10 of 10 episodes are others with another seed" in errors, status == 1, errors)

    def test_a_world_without_chance_is_told_step_by_step(self):
        """The test's plug-in: a reward of 1 for "go", and an end after six steps."""
        faulty = pathlib.Path(os.environ["FRESCO_BUILD"]) / "tests" / "plugins" / "faulty_world.so"
        config = self.config(f'plugin {{ library: "{faulty}" settings: "no chance" }}')
        summary = self.train(17765, "run", config=config)
        self.assertEqual(summary["score"], summary["return"])
        output, _ = self.run_fresco("evaluate", "--policy", self.folder / "run", "--format", "json")
        told = json.loads(output)
        self.assertEqual(list(told), ["policy", "walked", "steps", "return", "episode"])
        self.assertEqual((told["steps"], told["return"], told["walked"]),
                         (6, summary["return"], summary["return"] >= 5))
        *steps, last = told["episode"]
        self.assertEqual(last, {"step": 6, "steps": 6, "seed": 0, "action": None, "reward": None})
        self.assertEqual([step["step"] for step in steps], list(range(6)))
        for step in steps:
            self.assertEqual((step["steps"], step["seed"]), (step["step"], 0))
            self.assertEqual(step["reward"], {"go": 1, "stay": 0}[step["action"]])
        self.assertEqual(sum(step["reward"] for step in steps), told["return"])
        output, _ = self.run_fresco("evaluate", "--policy", self.folder / "run")
        header, *lines = output.splitlines()
        self.assertEqual(header.split(), ["step", "steps", "seed", "action", "reward"])
        self.assertEqual(lines[6].split(), ["6", "6", "0", "-", "-"])
        self.assertEqual(lines[7], "")
        walked = "walked" if told["walked"] else "not walked"
        self.assertEqual(lines[8], f"{self.folder / 'run'}: {walked}; return {told['return']:.3f}")
        self.assertNotIn("flight-data", (self.folder / "run" / "report.html").read_text())
        _, errors = self.run_fresco("fly", "--policy", self.folder / "run", expect=2)
        self.assertIn("the world faulty has no flights", errors)

    def test_a_failing_world_ends_actors_and_the_run_but_not_the_learner(self):
        faulty = pathlib.Path(os.environ["FRESCO_BUILD"]) / "tests" / "plugins" / "faulty_world.so"
        for number, (fault, reason) in enumerate({
                "crash in step": "crashed (segmentation fault) in step()",
                "hang in step": "did not return in time in step()",
                "a state of NaN": "the state's steps is nan"}.items()):
            with self.subTest(fault=fault):
                config = self.config(f'plugin {{ library: "{faulty}" settings: "{fault}" call_limit_s: 0.5 }}')
                folder = self.folder / f"faulty-{number}"
                _, errors = self.run_fresco("train", "--config", config, "--lcm-url", url(17763), "--out", folder,
                                            "--actors", 1, expect=1)
                self.assertIn("an actor ended 5 times right after its start, or in its world", errors)
                self.assertIn("faulty_world.so", errors)
                self.assertIn(reason, errors)
                self.assertNotIn("error", (folder / "learner.log").read_text())

    def test_refuses_code_that_is_missing_or_another(self):
        for world, reason in {
                'plugin { library: "/no/such.so" }': "plugin.library: can't read /no/such.so",
                "plugin {}": "plugin.library: expected the path of a shared library",
                'plugin { library: "/etc/passwd" }': "can't be loaded",
                f'plugin {{ library: "{EXAMPLE}" settings: "nonsense" }}': "refuses the settings",
                f'plugin {{ library: "{EXAMPLE}" library_crc32c: 5 }}': "the run's has 00000005",
                'python { object: "pole" }': "expected module:Class",
                f'python {{ object: "none:CartPole" path: "{PYTHON_WORLDS}" }}': "none.py",
                f'python {{ object: "pole:None" path: "{PYTHON_WORLDS}" }}': "has no attribute 'None'",
                f'python {{ object: "pole:CartPole" path: "{PYTHON_WORLDS}" }} agent {{ flown_return_bound: true }}':
                    "chance decides what an episode earns",
                f'python {{ object: "pole:CartPole" path: "{PYTHON_WORLDS}" }} schedule {{ search {{}} }}':
                    "schedule.search: set; allowed: omitted, since the environments of the world",
                f'plugin {{ library: "{EXAMPLE}" }} cartpole {{}}': "another member of oneof",
                f'plugin {{ library: "{EXAMPLE}" }} agent {{ safe_action_mask: true }}': "safe_action_mask"}.items():
            with self.subTest(world=world):
                path = self.folder / "wrong.textproto"
                path.write_text(world)
                _, errors = self.run_fresco("train", "--config", path, "--out", self.folder / "wrong", expect=2)
                self.assertIn(reason, errors)
                self.assertFalse((self.folder / "wrong").exists())

    def test_an_actor_runs_only_code_that_it_was_told_to(self):
        config = self.config(f'plugin {{ library: "{EXAMPLE}" }}')
        training = self.start("train", "--config", config, "--lcm-url", url(17764), "--out", self.folder / "run",
                              "--actors", 0, "--format", "json")
        with open(self.folder / "refusing.log", "w") as log:
            self.start("--lcm-url", url(17764), program="fresco-actor", stderr=log)
            wait_until(lambda: "--allow-code" in (self.folder / "refusing.log").read_text(), "the refusal")
        self.start("--lcm-url", url(17764), "--allow-code", EXAMPLE, program="fresco-actor",
                   stderr=subprocess.DEVNULL)
        self.assertTrue(self.summary_of(training)["completed"])


if __name__ == "__main__":
    unittest.main()
