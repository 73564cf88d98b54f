"""`fresco soak`: the same weights under every kind of fault, nothing left behind, and an end in order."""
import contextlib
import csv
import json
import os
import pathlib
import signal
import sys
import unittest

from fresco_process import CI_CONFIG, PATIENCE, SOAK_ARGUMENTS, FrescoTest, processes_with, url, wait_until

SHORT = ("--set", "schedule.episodes=800")


class Soak(FrescoTest):
    def start_soak(self, port, *arguments):
        return self.start("soak", "--config", CI_CONFIG, "--lcm-url", url(port), "--out", self.folder / "soak", "--format",
                          "json", *SOAK_ARGUMENTS, *arguments)

    def finish(self, process, expect):
        output, errors = process.communicate(timeout=300)
        self.assertEqual(process.returncode, expect, output + errors)
        return json.loads(output)

    def test_finds_the_same_weights_under_every_kind_of_fault(self):
        report = self.finish(self.start_soak(17390, "--minutes", 0.5 * PATIENCE, *SHORT), 0)
        self.assertEqual(report["verdict"], "equal")
        self.assertGreaterEqual(len(report["rounds"]), 1)
        self.assertEqual({r["weights_crc32c"] for r in report["rounds"]}, {report["undisturbed"]["weights_crc32c"]})
        kinds = [kind for kind, figures in report["faults"].items() if figures["number"] > 0]
        self.assertGreaterEqual(len(kinds), 3, report["faults"])
        self.assertEqual(report["transitions_lost"], 0)
        networks = {path.read_bytes() for path in (self.folder / "soak").glob("*/final.network")}
        self.assertEqual(len(networks), 1, "seen from outside, too")
        with open(self.folder / "soak" / "soak.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), sum(figures["number"] for figures in report["faults"].values()))
        self.assertEqual(processes_with(":17390"), [])
        self.assertEqual(list(self.folder.rglob("*.tmp*")), [])

    def test_has_a_round_again_with_its_key(self):
        key = self.key()
        arguments = ("--seed", 5, "--first-round", 9, "--rounds", 1, "--key-file", key, *SHORT)
        report = self.finish(self.start_soak(17391, *arguments), 0)
        self.assertEqual([r["round"] for r in report["rounds"]], [9])
        self.assertIn("--seed 5 --first-round 9 --rounds 1", report["rounds"][0]["repeat"])
        self.assertIn(f"--key-file '{key}'", report["rounds"][0]["repeat"])
        undisturbed = json.loads((self.folder / "soak" / "undisturbed" / "summary.json").read_text())
        self.assertEqual(undisturbed["bus"]["rejected_unauthenticated"], 0)
        first = pathlib.Path(self.folder / "soak").rename(self.folder / "first")
        again = self.finish(self.start_soak(17391, *arguments), 0)
        self.assertEqual(again["rounds"][0]["disturbance"], report["rounds"][0]["disturbance"])
        plans = []
        for folder in (first, self.folder / "soak"):
            with open(folder / "soak.csv", newline="") as file:
                plans.append([(row["at_s"], row["kind"], row["actor"], row["duration_s"])
                              for row in csv.DictReader(file)])
        shared = min(map(len, plans))
        self.assertGreaterEqual(shared, 1)
        self.assertEqual(plans[0][:shared], plans[1][:shared], "the shorter round has fewer of the same faults")

    def test_ends_in_order_on_ctrl_c(self):
        process = self.start_soak(17392, "--set", "schedule.episodes=1500")
        log = self.folder / "soak" / "round-1" / "guest.log"
        wait_until(log.exists, "an actor from outside")
        process.send_signal(signal.SIGINT)
        report = self.finish(process, 1)
        self.assertEqual(report["verdict"], "interrupted")
        self.assertEqual(report["failures"], [])
        self.assertEqual(processes_with(":17392"), [])

    def test_fails_where_a_learner_ends_that_nobody_killed(self):
        process = self.start_soak(17394, "--set", "schedule.episodes=1500")
        run = str(self.folder / "soak" / "round-1")

        def told_the_learner_to_end():
            for learner in set(processes_with("fresco-learner")) & set(processes_with(run)):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(learner, signal.SIGTERM)
            return process.poll() is not None

        wait_until(told_the_learner_to_end, "the soak to give up")
        report = self.finish(process, 1)
        self.assertEqual(report["verdict"], "failed")
        self.assertIn("ended by itself", report["rounds"][0]["failures"][0])
        self.assertIn("--seed 1 --first-round 1 --rounds 1", report["rounds"][0]["repeat"])
        self.assertEqual(processes_with(":17394"), [])

    def test_says_which_folder_and_which_time_do_not_do(self):
        (self.folder / "soak").mkdir()
        (self.folder / "soak" / "notes").write_text("mine")
        _, errors = self.run_fresco("soak", "--out", self.folder / "soak", expect=2)
        self.assertIn("not empty", errors)
        (self.folder / "soak" / "notes").unlink()
        report = self.finish(self.start_soak(17393, "--minutes", 0.05, "--set", "schedule.episodes=100000"), 1)
        self.assertEqual(report["verdict"], "failed")
        self.assertIn("more --minutes", report["failures"][0])
        self.assertEqual(processes_with(":17393"), [])


if __name__ == "__main__":
    sys.exit(unittest.main())
