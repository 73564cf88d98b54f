"""`fresco train --resume`: a learner that is killed at any moment costs time, never a bit."""
import json
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from fresco_process import CI_CONFIG, FrescoTest, processes_with, url, wait_until

LONGER = ("--set", "schedule.episodes=1200", "--set", "run.optimum_limit_s=0")
OFTEN = ("--set", "run.checkpoint_interval_s=0.02")


class Resume(FrescoTest):
    def start_training(self, port, name, *arguments, **options):
        return self.start("train", "--config", CI_CONFIG, "--lcm-url", url(port), "--out", self.folder / name, "--format",
                          "json", *LONGER, *OFTEN, *arguments, **options)

    def checkpoints(self, name):
        return sorted((self.folder / name / "checkpoints").glob("*.checkpoint"))

    def resume(self, name, *arguments, expect=0):
        output, errors = self.run_fresco("train", "--resume", self.folder / name, "--format", "json", *arguments,
                                         expect=expect)
        return output, errors

    def crc_of(self, output):
        return json.loads(output)["weights_crc32c"]

    def test_gives_the_same_weights_however_often_the_learner_is_killed(self):
        undisturbed = self.train(17351, "undisturbed", *LONGER)
        moments = random.Random(7)
        process = self.start_training(17351, "killed")
        for _ in range(4):
            before = self.checkpoints("killed")
            wait_until(lambda: self.checkpoints("killed") not in ([], before), "a further checkpoint")
            time.sleep(moments.uniform(0, 0.1))  # the moment of the kill, not a wait for a result
            os.kill(self.learner_of("killed"), signal.SIGKILL)
            _, errors = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 1, errors)
            self.assertIn("--resume", errors)
            process = self.start("train", "--resume", self.folder / "killed", "--format", "json")
        output, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(self.crc_of(output), undisturbed["weights_crc32c"])
        summary = json.loads(output)
        self.assertEqual(summary["resumptions"], 4)
        self.assertEqual(summary["total_aoi"], undisturbed["total_aoi"])
        self.assertLessEqual(len(self.checkpoints("killed")), 2)
        columns = [[line.split(",")[1:] for line in (self.folder / name / "metrics.csv").read_text().splitlines()]
                   for name in ("undisturbed", "killed")]
        self.assertEqual(*columns, "metrics.csv but for the time")
        self.assertEqual(processes_with(":17351"), [])

    def test_goes_on_where_ctrl_c_ended_it_with_other_actors_on_another_port(self):
        undisturbed = self.train(17352, "undisturbed", *LONGER)
        process = self.start_training(17352, "interrupted", "--set", "run.checkpoint_interval_s=0")
        wait_until(lambda: (self.folder / "interrupted" / "metrics.csv").exists(), "a first evaluation")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        self.assertEqual(len(self.checkpoints("interrupted")), 1)
        output, _ = self.resume("interrupted", "--actors", 3, "--lcm-url", url(17353))
        self.assertEqual(self.crc_of(output), undisturbed["weights_crc32c"])
        _, errors = self.resume("interrupted", expect=2)
        self.assertIn("complete", errors)

    def test_uses_the_checkpoint_before_where_the_last_is_torn(self):
        undisturbed = self.train(17354, "undisturbed", *LONGER)
        process = self.start_training(17354, "torn")
        wait_until(lambda: len(self.checkpoints("torn")) >= 2, "two checkpoints")
        process.kill()  # the learner ends in order and leaves another checkpoint
        process.communicate()
        wait_until(lambda: not processes_with(str(self.folder)), "the processes to end")
        last = self.checkpoints("torn")[-1]
        last.write_bytes(last.read_bytes()[:70000])
        output, errors = self.resume("torn")
        self.assertIn("cut short", errors)
        self.assertEqual(self.crc_of(output), undisturbed["weights_crc32c"])

    def test_refuses_what_it_can_not_go_on_with(self):
        _, errors = self.resume("absent", expect=2)
        self.assertIn("can't open the folder", errors)
        (self.folder / "empty").mkdir()
        _, errors = self.resume("empty", expect=2)
        self.assertIn("config.textproto", errors)
        process = self.start_training(17355, "run", "--set", "schedule.episodes=1000000")
        wait_until(lambda: self.checkpoints("run"), "a checkpoint")
        _, errors = self.run_fresco("--resume", self.folder / "run", "--lcm-url", url(17356), program="fresco-learner",
                                    expect=2)
        self.assertIn("at work in this folder", errors)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        _, errors = self.resume("run", "--set", "schedule.episodes=7", expect=2)
        self.assertIn("only fields of run", errors)
        _, errors = self.run_fresco("train", "--config", CI_CONFIG, "--lcm-url", url(17355), "--out",
                                    self.folder / "run", expect=2)
        self.assertIn("another run's results", errors)
        (self.folder / "run" / "summary.json").unlink()
        _, errors = self.run_fresco("train", "--config", CI_CONFIG, "--lcm-url", url(17355), "--out",
                                    self.folder / "run", expect=2)
        self.assertIn("--resume", errors)
        for checkpoint in self.checkpoints("run"):
            checkpoint.write_bytes(b"P5 640 480")
        _, errors = self.resume("run", expect=2)
        self.assertIn("not a checkpoint of Fresco", errors)

    def test_trains_on_where_checkpoints_can_not_be_written(self):
        self.train(17357, "undisturbed", *LONGER, *OFTEN)
        # No file may be larger than this: like a full disk for checkpoints, not for the small files.
        limit = 150_000
        process = self.start_training(
            17357, "full", restore_signals=False,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        output, errors = process.communicate(timeout=240)
        log = (self.folder / "full" / "learner.log").read_text()
        self.assertIn("can't write", log)
        self.assertIn(".checkpoint", log)
        self.assertEqual(process.returncode, 1, errors + log)  # the last checkpoint could not be written
        final = (self.folder / "full" / "final.network").read_bytes()
        self.assertEqual(final, (self.folder / "undisturbed" / "final.network").read_bytes())
        self.assertEqual(list((self.folder / "full").rglob("*.tmp*")), [])

    @unittest.skipIf(os.geteuid() != 0, "only root may mount a small file system")
    def test_keeps_the_old_checkpoint_on_a_full_disk_and_goes_on_when_there_is_room(self):
        undisturbed = self.train(17358, "undisturbed", *LONGER)
        disk = self.folder / "disk"
        disk.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", disk], check=True)
        self.addCleanup(subprocess.run, ["umount", "-l", disk], check=True)
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17358), "--out", disk / "run", "--format",
                             "json", "--set", "schedule.episodes=1200", "--set", "run.optimum_limit_s=0", *OFTEN)
        checkpoints = disk / "run" / "checkpoints"
        wait_until(lambda: list(checkpoints.glob("*.checkpoint")), "a checkpoint")
        filler = disk / "filler"
        try:
            with open(filler, "wb") as file:
                while True:
                    file.write(bytes(4096))
                    file.flush()
        except OSError:
            pass
        log = disk / "run" / "learner.log"
        wait_until(lambda: "No space left" in log.read_text() or process.poll() is not None, "the full disk")
        # What a learner that is killed now would leave.
        shutil.copytree(disk / "run", self.folder / "while-full", ignore=shutil.ignore_patterns("*.tmp*"))
        filler.unlink()
        output, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, 0, errors + log.read_text())
        self.assertEqual(self.crc_of(output), undisturbed["weights_crc32c"])
        self.assertTrue(self.checkpoints("while-full"), "the old checkpoint is there")
        output, errors = self.resume("while-full")
        self.assertNotIn("unusable", errors)
        self.assertEqual(self.crc_of(output), undisturbed["weights_crc32c"])


if __name__ == "__main__":
    sys.exit(unittest.main())
