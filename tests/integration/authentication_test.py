"""Message authentication with real processes over real LCM: `--key-file`."""
import hashlib
import json
import os
import signal
import subprocess
import sys
import unittest

from fresco_process import BIN, CI_CONFIG, FrescoTest, read_log, url, wait_until

TAG_BYTES = 32


class Authentication(FrescoTest):
    def start_actor(self, port, *arguments):
        return self.start("--lcm-url", url(port), *arguments, program="fresco-actor")

    def stop_actor(self, process):
        process.send_signal(signal.SIGTERM)
        _, log = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, log)
        return log

    def train_among_strangers(self, port, name, key, friend, strangers):
        """A learner alone hears strangers only; the friend comes when the learner has said so in its log."""
        actors = [self.start_actor(port, *arguments) for arguments in strangers]
        learner = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(port), "--out",
                                    self.folder / name, "--actors", 0, "--format", "json", *key)
        log = self.folder / name / "learner.log"
        wait_until(lambda: log.exists() and "messages dropped" in log.read_text(), "the learner to hear strangers")
        friend = self.start_actor(port, *friend)
        output, errors = learner.communicate(timeout=120)
        self.assertEqual(learner.returncode, 0, errors)
        self.assertIn("1 run(s) served", self.stop_actor(friend))
        logs = [self.stop_actor(actor) for actor in actors]
        for text in logs:
            self.assertIn("0 run(s) served, 0 episodes", text)
        return json.loads(output), log.read_text(), logs

    def test_changes_no_weights_and_no_configuration(self):
        open_run = self.train(17410, "open")
        closed_run = self.train(17410, "closed", "--key-file", self.key())
        self.assertEqual(closed_run["weights_crc32c"], open_run["weights_crc32c"])
        self.assertEqual(closed_run["config_hash"], open_run["config_hash"])
        self.assertEqual(closed_run["bus"]["rejected"], 0)
        self.assertEqual((self.folder / "closed" / "config.textproto").read_text(),
                         (self.folder / "open" / "config.textproto").read_text())

    def test_keeps_actors_with_another_key_or_none_out_and_tells_them_why(self):
        key = ["--key-file", self.key()]
        summary, learner_log, logs = self.train_among_strangers(
            17411, "run", key, friend=key, strangers=[["--key-file", self.key("other")], []])
        self.assertEqual(summary["weights_crc32c"], self.train(17411, "open")["weights_crc32c"])
        self.assertGreater(summary["bus"]["rejected_unauthenticated"], 0)
        self.assertEqual(summary["bus"]["rejected"], summary["bus"]["rejected_unauthenticated"])
        self.assertIn("made with another key than that of --key-file here, or with none", learner_log)
        self.assertIn("made with another key than that of --key-file here, or with none", logs[0])
        self.assertIn("made with a key, and no --key-file is given here", logs[1])
        for log in [learner_log, *logs]:
            self.assertEqual(log.count("messages dropped"), 1)

    def test_keeps_an_actor_with_a_key_out_of_a_run_without_one_and_tells_both_why(self):
        summary, learner_log, logs = self.train_among_strangers(
            17412, "run", [], friend=[], strangers=[["--key-file", self.key()]])
        self.assertGreater(summary["bus"]["rejected_malformed"], 0)
        self.assertIn("made with a key, and no --key-file is given here", learner_log)
        self.assertIn("made with another key than that of --key-file here, or with none", logs[0])

    def test_is_gone_on_with_by_the_command_that_an_interrupted_run_names(self):
        arguments = ["--set", "schedule.episodes=1000", "--key-file", self.key()]
        whole = self.train(17415, "whole", *arguments)
        folder = self.folder / "stopped"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17415), "--out", folder,
                                    *arguments)
        wait_until(lambda: (folder / "metrics.csv").exists(), "a first evaluation")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 1, errors)
        program, *command = errors.split("continue it with: ")[1].split()
        self.assertEqual(program, str(BIN / "fresco"))  # as it was called
        self.assertIn("--key-file", command)
        output, _ = self.run_fresco(*command, "--format", "json")
        self.assertEqual(json.loads(output)["weights_crc32c"], whole["weights_crc32c"])

    def test_stands_in_every_message_of_a_run_within_a_single_frame(self):
        key, log = self.key(), self.folder / "lcm.log"
        logger = subprocess.Popen(["lcm-logger", "--lcm-url=" + url(17413) + "&recv_buf_size=4194304", "-f", log],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            wait_until(log.exists, "lcm-logger")
            self.train(17413, "logged", "--key-file", key)
        finally:
            logger.terminate()
            logger.wait(10)
        secret = hashlib.blake2b(key.read_bytes(), digest_size=32).digest()
        channels = set()
        for channel, data in read_log(log):
            if channel != "LCM_SELF_TEST":  # LCM's own, at the start of a program
                channels.add(channel)
                self.assertLessEqual(len(data), 1350, channel)
                tag = hashlib.blake2b(channel.encode() + b"\0" + data[:-TAG_BYTES], key=secret, digest_size=TAG_BYTES)
                self.assertEqual(data[-TAG_BYTES:], tag.digest(), channel)
        self.assertEqual(len(channels), 9)

    def test_refuses_a_bad_key_file_with_the_command_that_mends_it(self):
        making = "head -c 32 /dev/urandom > "
        bad = [(self.folder / "none", [making, "No such file"]), (self.folder, [making, "directory"]), ("", [making]),
               (self.key("short", b"k" * 31), [making, "found 31", "32 to 65536"]),
               (self.key("shown", mode=0o644), ["chmod 600 '", "mode 644"])]
        train = ["train", "--config", CI_CONFIG, "--lcm-url", url(17414), "--out", self.folder / "out"]
        learner = ["--config", CI_CONFIG, "--lcm-url", url(17414), "--out", self.folder / "out"]
        figures = ["figures", "--quick", "--lcm-url", url(17414), "--out", self.folder / "study"]
        soak = ["soak", "--lcm-url", url(17414), "--out", self.folder / "out"]
        for path, words in bad:
            for program, arguments in [("fresco", train), ("fresco", figures), ("fresco", soak), ("fresco-learner", learner),
                                       ("fresco-actor", ["--lcm-url", url(17414)])]:
                with self.subTest(program=program, path=path):
                    _, errors = self.run_fresco(*arguments, "--key-file", path, program=program, expect=2)
                    for word in [f"--key-file: {path}", *words]:
                        self.assertIn(word, errors)
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    sys.exit(unittest.main())
