"""`fresco watch`: what it shows of a run, of an actor that joins from another host, and of an empty bus."""
import os
import pty
import re
import signal
import subprocess
import unittest

import network_hosts
from fresco_process import BIN, CI_CONFIG, FrescoTest, url, wait_until

ENDLESS = ["--set", "schedule.episodes=1000000", "--set", "run.optimum_limit_s=0"]


class Watch(FrescoTest):
    def once(self, port, expect=0):
        return self.run_fresco("watch", "--once", "--lcm-url", url(port), expect=expect)[0]

    def end_later(self, run):
        """Ends it, with its learner, before its folder is removed."""
        def end():
            run.send_signal(signal.SIGINT)
            run.communicate(timeout=60)
        self.addCleanup(end)

    def start_run(self, port):
        self.end_later(self.start("train", "--config", CI_CONFIG, "--lcm-url", url(port), "--out", self.folder / "run",
                                  "--actors", 2, *ENDLESS, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
        wait_until(lambda: self.learner_of("run"), "a learner")
        self.wait_for_evaluation("run")

    def test_shows_learner_and_actors_as_text(self):
        self.start_run(7860)
        text = self.once(7860)
        self.assertRegex(text, f"(?m)^run {self.run_id('run'):016x}, world uav$")
        self.assertRegex(text, r"(?ms)^ +\d+% \| \d+ of 1000000 episodes \| \d+ updates .* greedy average AoI \d+\.\d+.*2 actors")
        self.assertRegex(text, r"for comparison: AoI-based \d+\.\d+, distance-based \d+\.\d+")
        self.assertRegex(text, r"loss 0?\.?\d.* transitions in the replay memory")
        self.assertEqual(len(re.findall(r"(?m)^  \S+:\d+ +\d+ +\d+/\d+ +\d+ +\d+ +0 +\d+\.\d$", text)), 2, text)
        self.assertRegex(text, r"(?m)^[1-9]\d+ messages/s on the bus, 0 damaged$")
        self.assertNotIn("\x1b", text)

    def test_says_that_there_is_no_run(self):
        self.assertEqual(self.once(7861, expect=1), "no run heard\n0 messages/s on the bus, 0 damaged\n")

    def test_draws_in_a_terminal_until_q(self):
        self.start_run(7862)
        master, slave = pty.openpty()
        watch = subprocess.Popen([BIN / "fresco", "watch", "--lcm-url", url(7862)], stdin=slave, stdout=slave,
                                 stderr=subprocess.PIPE, env={**os.environ, "TERM": "xterm", "LINES": "30", "COLUMNS": "100"})
        self.addCleanup(watch.kill)
        os.close(slave)
        screen = b""
        while not re.search(rb"world uav.*transitions/s", screen, re.DOTALL):
            screen += os.read(master, 4096)
        os.write(master, b"q")
        try:
            while os.read(master, 4096):  # it ends only when what it draws is read
                pass
        except OSError:
            pass  # the terminal is closed
        self.assertEqual(watch.wait(20), 0, watch.stderr.read())
        watch.stderr.close()
        os.close(master)

    def test_train_shows_its_run_on_a_terminal(self):
        master, slave = pty.openpty()
        train = subprocess.Popen([BIN / "fresco", "train", "--config", CI_CONFIG, "--lcm-url", url(7864), "--out", self.folder / "run",
                                  "--set", "schedule.episodes=1000"],
                                 stdin=slave, stdout=subprocess.DEVNULL, stderr=slave, env={**os.environ, "TERM": "xterm"})
        self.addCleanup(train.kill)
        os.close(slave)
        screen = b""
        try:
            while part := os.read(master, 65536):
                screen += part
        except OSError:
            pass  # the terminal is closed
        self.assertEqual(train.wait(60), 0)
        os.close(master)
        screens = screen.decode().replace("\r", "").split("\x1b[J")
        self.assertRegex(screens[-1], r"^run [0-9a-f]{16}, world uav\n  \[#+ *\]")
        self.assertRegex(screens[-1],
                         r"average AoI \[slots\]: \* best so far, \. evaluations[^\n]*\n( +[\d.]+ \||  +\|)")
        self.assertNotIn("messages/s on the bus", screen.decode())

    def test_prints_texts_without_a_terminal_until_it_is_told_to_end(self):
        watch = self.start("watch", "--lcm-url", url(7863))
        self.assertEqual(watch.stdout.readline(), "no run heard\n")
        watch.send_signal(signal.SIGINT)
        watch.communicate(timeout=20)

    def test_shows_an_actor_of_another_host(self):
        reason = network_hosts.why_not()
        if reason:
            self.skipTest(reason)
        hosts = network_hosts.Hosts(2)
        self.addCleanup(hosts.remove)
        lcm_url = "udpm://239.255.76.67:7667?ttl=1"
        run = self.start_command(hosts.command(0, BIN / "fresco", "train", "--config", CI_CONFIG, "--lcm-url", lcm_url, "--actors", 0,
                                               "--out", self.folder / "run", *ENDLESS), stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        self.end_later(run)
        actor = self.start_command(hosts.command(1, BIN / "fresco-actor", "--lcm-url", lcm_url), stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        self.wait_for_evaluation("run")
        watch = self.start_command(hosts.command(1, BIN / "fresco", "watch", "--once", "--lcm-url", lcm_url))
        text, errors = watch.communicate(timeout=60)
        self.assertEqual(watch.returncode, 0, errors)
        self.assertIn("1 actors", text)
        self.assertRegex(text, rf"(?m)^  \S+:{actor.pid} ")


if __name__ == "__main__":
    unittest.main()
