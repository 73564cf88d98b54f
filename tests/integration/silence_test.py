"""Nobody there, or nobody who can work: a run says what it waits for, and ends in order or goes on."""
import json
import os
import shutil
import signal
import sys
import time
import unittest

from fresco_process import BIN, CI_CONFIG, FrescoTest, actors_on, processes_with, url, wait_until

LONGER = ("--set", "schedule.episodes=1000", "--set", "run.optimum_limit_s=0")


class Silence(FrescoTest):
    def test_ends_in_order_with_a_checkpoint_where_no_actor_joins(self):
        output, errors = self.run_fresco("train", "--config", CI_CONFIG, "--lcm-url", url(17370), "--out",
                                         self.folder / "alone", "--actors", 0, "--set", "run.patience_s=3", "--format",
                                         "json", expect=1)
        self.assertFalse(json.loads(output)["completed"])
        self.assertIn("train --resume", errors)
        self.assertTrue(list((self.folder / "alone" / "checkpoints").glob("*.checkpoint")))
        log = (self.folder / "alone" / "learner.log").read_text()
        self.assertIn("giving up: no result for 3 s (run.patience_s), waiting for an actor to join", log)
        self.assertIn("giving up: no result for 3 s", errors)

    def test_gives_up_without_waiting_for_a_long_search_for_the_optimum(self):
        config = self.folder / "many_sensors.textproto"
        config.write_text("scenario { random_sensors { count: 40 seed: 1 } } run { optimum_limit_s: 3600 patience_s: 3 }")
        output, _ = self.run_fresco("train", "--config", config, "--lcm-url", url(17374), "--out", self.folder / "long",
                                    "--actors", 0, "--format", "json", expect=1)
        self.assertIsNone(json.loads(output)["optimal_total_aoi"])

    def test_ends_in_order_where_all_actors_leave_and_goes_on_when_they_come_back(self):
        undisturbed = self.train(17371, "undisturbed", *LONGER)
        actor = self.start("--lcm-url", url(17371), program="fresco-actor")
        learner = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17371), "--out", self.folder / "left",
                             "--actors", 0, "--set", "run.patience_s=3", *LONGER, "--format", "json")
        self.wait_for_evaluation("left")
        actor.kill()
        actor.communicate()
        _, errors = learner.communicate(timeout=60)
        self.assertEqual(learner.returncode, 1, errors)
        self.assertRegex(errors, r"giving up: no result for 3 s .*, waiting for an actor: .* was last heard of 3\.\d s ago")
        output, _ = self.run_fresco("train", "--resume", self.folder / "left", "--actors", 2, "--format", "json")
        self.assertEqual(json.loads(output)["weights_crc32c"], undisturbed["weights_crc32c"])

    def test_gives_up_in_the_actors_own_words_where_it_can_never_start(self):
        programs = self.folder / "bin"
        programs.mkdir()
        for name in ("fresco", "fresco-learner"):
            shutil.copy(BIN / name, programs / name)
        actor = programs / "fresco-actor"
        actor.write_text("#!/bin/sh\necho 'this host has no such processor' >&2\nexit 3\n")
        actor.chmod(0o755)
        process = self.start_command([programs / "fresco", "train", "--config", CI_CONFIG, "--lcm-url", url(17372), "--out",
                                      self.folder / "hopeless"])
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("an actor ended 5 times right after its start", errors)
        self.assertIn("this host has no such processor", errors)
        wait_until(lambda: not processes_with(str(self.folder)), "the processes to end")

    def test_starts_an_actor_that_is_killed_at_once_again_after_growing_pauses(self):
        undisturbed = self.train(17373, "undisturbed", "--actors", 1, *LONGER)
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17373), "--out", self.folder / "killed",
                             "--actors", 1, *LONGER, "--format", "json")
        killed, begin = set(), time.monotonic()
        while time.monotonic() < begin + 4:  # how long the fault lasts
            for pid in set(actors_on(17373)) - killed:
                os.kill(pid, signal.SIGKILL)
                killed.add(pid)
            time.sleep(0.005)
        self.assertEqual(self.summary_of(process)["weights_crc32c"], undisturbed["weights_crc32c"])
        # Pauses of 0.1, 0.2, 0.4, 0.8, 1.6, .. s: seven starts in four seconds at most.
        self.assertGreater(len(killed), 2)
        self.assertLessEqual(len(killed), 7)


if __name__ == "__main__":
    sys.exit(unittest.main())
