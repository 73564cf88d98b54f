"""`fresco retrain`: a recorded log is worth as much as the run, whoever recorded it and whatever it misses."""
import json
import signal
import struct
import subprocess
import unittest

from fresco_process import CI_CONFIG, FrescoTest, read_log, url, wait_until

QUICK = ("--set", "run.optimum_limit_s=0")


def write_log(path, events):
    with open(path, "wb") as log:
        for number, (channel, data) in enumerate(events):
            log.write(struct.pack(">IqqII", 0xEDA1DA01, number, number, len(channel), len(data)) + channel.encode() + data)


class Retrain(FrescoTest):
    def record(self, port, name, *arguments):
        """A run with two actors and its log."""
        summary = self.train(port, name, "--actors", 2, "--record", *QUICK, *arguments)
        return summary, self.folder / name / "traffic.lcm"

    def retrain(self, *arguments, expect=0):
        self.retrainings = getattr(self, "retrainings", 0) + 1
        output, errors = self.run_fresco("retrain", *arguments, "--out", self.folder / f"again-{self.retrainings}",
                                         "--format", "json", expect=expect)
        return (json.loads(output), errors) if output else (None, errors)

    def expect_same(self, retrained, live):
        self.assertEqual(retrained["weights_crc32c"], live["weights_crc32c"])
        for key in ("config_hash", "episodes", "transitions", "updates", "total_aoi", "staleness_updates"):
            self.assertEqual(retrained[key], live[key], key)
        self.assertTrue(retrained["retrain"]["same_configuration"])
        self.assertEqual(retrained["retrain"]["recorded_run_id"], live["run_id"])
        self.assertEqual(retrained["retrain"]["different_versions"], 0)

    def test_gives_the_weights_of_the_recorded_run(self):
        live, log = self.record(17651, "live")
        retrained, _ = self.retrain(log, "--config", CI_CONFIG, *QUICK, "--strict")
        self.expect_same(retrained, live)
        self.assertEqual(retrained["retrain"]["flown_again"], 0)
        self.assertGreater(retrained["retrain"]["compared_versions"], 10)
        columns = [[line.split(",")[1:] for line in (self.folder / name / "metrics.csv").read_text().splitlines()]
                   for name in ("live", "again-1")]
        self.assertEqual(*columns, "metrics.csv but for the time")
        for name in ("final.network", "best.network", "report.html"):
            self.assertTrue((self.folder / "again-1" / name).exists(), name)
        # The recorded configuration needs no file; the log may be cut short; another folder's results stay.
        torn = self.folder / "torn"
        torn.write_bytes(log.read_bytes()[:-log.stat().st_size // 3])
        retrained, _ = self.retrain(torn)
        self.expect_same(retrained, live)
        self.assertGreater(retrained["retrain"]["flown_again"], 50)
        self.assertGreater(retrained["retrain"]["torn_bytes"], 0)
        _, errors = self.run_fresco("retrain", log, "--out", self.folder / "live", expect=2)
        self.assertIn("another run's results", errors)

    def test_flies_again_what_is_missing(self):
        live, log = self.record(17652, "live")
        events = []
        count = 0
        for channel, data in read_log(log):
            if channel == "FRESCO_TRANSITIONS":
                count += 1
                if count % 10 == 0:
                    continue
            events.append((channel, data))
        write_log(self.folder / "tenth", events)
        retrained, _ = self.retrain(self.folder / "tenth", "--config", CI_CONFIG, *QUICK)
        self.expect_same(retrained, live)
        self.assertGreater(retrained["retrain"]["flown_again"], 50)
        _, errors = self.retrain(self.folder / "tenth", "--config", CI_CONFIG, *QUICK, "--strict", expect=1)
        self.assertRegex(errors, r"misses the episodes of orders \d+( to \d+)?, ")
        # Two recorders that missed different things make one whole log.
        write_log(self.folder / "others", [event for event in read_log(log) if event not in set(events)])
        retrained, _ = self.retrain(self.folder / "others", self.folder / "tenth", *QUICK, "--strict")
        self.expect_same(retrained, live)
        self.assertEqual(retrained["retrain"]["flown_again"], 0)

    def test_takes_the_log_of_a_plain_lcm_logger(self):
        log = self.folder / "plain"
        logger = self.start_command(["lcm-logger", f"--lcm-url={url(17653)}&recv_buf_size=4194304", "-q", str(log)])
        wait_until(log.exists, "lcm-logger")
        live = self.train(17653, "live", "--actors", 2, *QUICK)
        logger.send_signal(signal.SIGINT)
        logger.communicate(timeout=20)
        retrained, _ = self.retrain(log, "--config", CI_CONFIG, *QUICK)
        self.expect_same(retrained, live)
        self.assertGreater(retrained["retrain"]["recorded_episodes"], 0)

    def test_takes_only_what_the_key_made(self):
        key = ("--key-file", self.key())
        live, log = self.record(17654, "live", *key)
        for arguments in (key, ()):
            retrained, _ = self.retrain(log, *arguments, *QUICK, "--strict")
            self.expect_same(retrained, live)
        _, errors = self.retrain(log, "--key-file", self.key("other"), expect=2)
        self.assertIn("no run of Fresco", errors)

    def test_trains_another_agent_offline_and_says_so(self):
        live, log = self.record(17655, "live")
        output, _ = self.run_fresco("retrain", log, "--set", "agent.hidden_layers=32", "--set", "agent.double_dqn=false",
                                    *QUICK, "--out", self.folder / "text")
        self.assertIn("experience for another agent", output)
        self.assertIn("not the recorded run", output)
        episodes = live["episodes"]
        self.assertIn(f"another agent, trained offline: {episodes} recorded episodes", output)
        summary = json.loads((self.folder / "text" / "summary.json").read_text())
        self.assertNotEqual(summary["weights_crc32c"], live["weights_crc32c"])
        self.assertFalse(summary["retrain"]["same_configuration"])
        self.assertEqual(summary["episodes"], episodes)
        # The same again: what is offline follows from the log and the configuration alone.
        again, _ = self.retrain(log, "--set", "agent.hidden_layers=32", "--set", "agent.double_dqn=false", *QUICK)
        self.assertEqual(again["weights_crc32c"], summary["weights_crc32c"])

        _, errors = self.retrain(log, "--set", f"schedule.episodes={episodes + 1}", *QUICK, expect=2)
        self.assertIn(f"--set schedule.episodes={episodes}", errors)
        _, errors = self.retrain(log, "--set", "scenario.coverage_radius_m=90", *QUICK, expect=2)
        self.assertIn("another world", errors)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["again-1", "live", "text"])

    def test_refuses_what_is_no_log_or_holds_no_run(self):
        foreign = self.folder / "foreign"
        foreign.write_text("no log")
        _, errors = self.retrain(foreign, expect=2)
        self.assertIn("expected an LCM event log", errors)
        _, errors = self.retrain(self.folder / "absent", expect=2)
        self.assertIn("No such file", errors)
        write_log(self.folder / "camera", [("CAMERA", b"picture")])
        _, errors = self.retrain(self.folder / "camera", expect=2)
        self.assertIn("no run of Fresco", errors)


class Replay(FrescoTest):
    def test_an_old_run_on_the_port_changes_nothing_in_a_live_one(self):
        old = self.train(17656, "old", "--record", "--seed", 2, *QUICK)
        undisturbed = self.train(17656, "undisturbed", *QUICK)
        live = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17656), "--out", self.folder / "live",
                          "--format", "json", *QUICK)
        self.wait_for_evaluation("live")
        player = self.start_command(["lcm-logplayer", "-s", "4", f"--lcm-url={url(17656)}",
                                     str(self.folder / "old" / "traffic.lcm")])
        summary = self.summary_of(live)
        self.assertEqual(summary["weights_crc32c"], undisturbed["weights_crc32c"])
        self.assertNotEqual(summary["weights_crc32c"], old["weights_crc32c"])
        self.assertGreater(summary["bus"]["rejected"], 0)
        player.kill()


if __name__ == "__main__":
    unittest.main()
