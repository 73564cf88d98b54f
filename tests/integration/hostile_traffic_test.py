"""A flood of hostile packets on the port of a run: counted, bounded in memory and log, and without a trace in the weights
or in what is recorded."""
import json
import pathlib
import random
import re
import signal
import struct
import subprocess
import sys
import unittest

from fresco_process import CI_CONFIG, PATIENCE, FrescoTest, actors_on, read_log, url, wait_until
from hostile_packets import Flood, Recorder, hostile_fragments, hostile_packets

PORT = 17380
RECORDED_PORT = 17381
FRAGMENTS_PER_S = 5000
PACKETS_PER_S = 25_000
MORE_MEMORY_MB = 150
EXPERIMENT = ("--config", CI_CONFIG, "--set", "schedule.episodes=1500", "--set", "run.optimum_limit_s=0")


def peak_mb(pid):
    try:
        found = re.search(r"VmHWM:\s+(\d+) kB", pathlib.Path(f"/proc/{pid}/status").read_text())
    except OSError:
        found = None
    return int(found[1]) / 1e3 if found else 0


class HostileTraffic(FrescoTest):
    def begin(self, name, *arguments):
        return self.start("train", *EXPERIMENT, "--lcm-url", url(PORT), "--out", self.folder / name, "--format", "json",
                          *arguments)

    def watch(self, name, process):
        """The summary, and the most memory that learner and actors took until the end, in MB by program."""
        peaks = {"fresco-learner": 0, "fresco-actor": 0}
        while process.poll() is None:
            learner = self.learner_of(name)
            for program, pids in (("fresco-learner", [learner] if learner else []), ("fresco-actor", actors_on(PORT))):
                peaks[program] = max([peaks[program], *map(peak_mb, pids)])
            try:
                process.wait(0.05)
            except subprocess.TimeoutExpired:
                pass
        return self.summary_of(process), peaks

    def flooded(self, name, recorded, *arguments):
        """From the first evaluation: before, another run's announcements would keep it from starting."""
        process = self.begin(name, *arguments)
        self.wait_for_evaluation(name)
        flood = Flood(PORT, hostile_packets(recorded, self.run_id(name)), PACKETS_PER_S)
        summary, peaks = self.watch(name, process)
        counts, packets_per_s = flood.end()
        print(f"{name}: weights_crc32c {summary['weights_crc32c']}, {summary['wall_s']:.1f} s, {sum(counts.values())} packets, "
              f"{packets_per_s:.0f} a second\n  sent: {counts}\n  counted: {summary['bus']}\n  memory, MB: {peaks}", flush=True)
        self.assertGreater(packets_per_s, 20_000 / PATIENCE)
        return summary, peaks, counts

    def expect_nothing_but_counts(self, name, undisturbed, summary, usual, peaks):
        for what in ("weights_crc32c", "transitions", "updates", "total_aoi"):
            self.assertEqual(summary[what], undisturbed[what], what)
        for program, peak in peaks.items():
            self.assertLess(peak, usual[program] + MORE_MEMORY_MB, program)
        for log in (self.folder / name).glob("*.log"):
            self.assertLess(log.stat().st_size, 20_000, f"{log} is flooded")

    def test_changes_nothing_and_is_counted_by_cause(self):
        recorder = Recorder(PORT)
        undisturbed, usual = self.watch("undisturbed", self.begin("undisturbed"))
        recorded = recorder.end()
        print(f"undisturbed: weights_crc32c {undisturbed['weights_crc32c']}, memory, MB: {usual}", flush=True)

        summary, peaks, sent = self.flooded("flooded", recorded)
        self.expect_nothing_but_counts("flooded", undisturbed, summary, usual, peaks)
        self.assertGreater(min(sent.values()), 0)
        bus = summary["bus"]
        self.assertGreater(bus["rejected_malformed"], 1000)
        self.assertGreater(bus["rejected_foreign"], 1000)
        self.assertEqual(bus["rejected"], bus["rejected_malformed"] + bus["rejected_foreign"])
        for log in (self.folder / "flooded").glob("actor-*.log"):
            for cause in ("malformed", "foreign"):
                self.assertGreater(int(re.search(rf"rejected.* (\d+) {cause}", log.read_text())[1]), 1000)

        summary, peaks, _ = self.flooded("flooded-with-key", recorded, "--key-file", self.key())
        self.expect_nothing_but_counts("flooded-with-key", undisturbed, summary, usual, peaks)
        self.assertGreater(summary["bus"]["rejected_unauthenticated"], 1000)
        self.assertEqual(summary["bus"]["rejected"], summary["bus"]["rejected_unauthenticated"])


class HostileFragments(FrescoTest):
    """Recorders hear all channels, and put messages of many packets together."""

    def begin_flood(self):
        flood = Flood(RECORDED_PORT, hostile_fragments(), FRAGMENTS_PER_S)
        self.addCleanup(flood.end)
        return flood

    def end_flood(self, flood):
        counts, packets_per_s = flood.end()
        print(f"{packets_per_s:.0f} fragments a second: {counts}", flush=True)
        self.assertGreater(packets_per_s, 1000 / PATIENCE)
        self.assertGreater(min(counts.values()), 0)

    def play_a_large_message(self):
        """LCM's own player sends it, a megabyte in fragments, ten times a second; returns it and what ends the player."""
        message, path = random.Random(1).randbytes(1_000_000), self.folder / "large.lcm"
        path.write_bytes(b"".join(
            struct.pack(">IqqII", 0xEDA1DA01, number, 10**15 + number * 10**5, 5, len(message)) + b"LARGE" + message
            for number in range(100)))
        player = self.start_command(["lcm-logplayer", "--lcm-url=" + url(RECORDED_PORT), path], stdout=subprocess.DEVNULL)

        def end():
            player.kill()
            player.communicate()
        return message, end

    def expect_nothing_hostile(self, events, large):
        self.assertNotIn("ATTACK", {channel for channel, _ in events})
        heard = [content for channel, content in events if channel == "LARGE"]
        self.assertGreater(len(heard), 0)
        self.assertEqual(set(heard), {large})

    def test_leave_no_trace_in_a_recorded_run(self):
        process = self.start("train", *EXPERIMENT, "--lcm-url", url(RECORDED_PORT), "--out", self.folder / "run", "--format",
                             "json", "--record")
        self.wait_for_evaluation("run")
        flood = self.begin_flood()
        large, end_player = self.play_a_large_message()
        summary = self.summary_of(process)
        end_player()
        self.end_flood(flood)
        log = self.folder / "run" / "traffic.lcm"
        self.expect_nothing_hostile(list(read_log(log)), large)
        [run] = json.loads(self.run_fresco("log", "info", log, "--format", "json")[0])["runs"]
        self.assertTrue(run["finished"])
        self.assertEqual((run["transitions_missing"], run["episodes_partial"], run["orders_without_transitions"]), (0, 0, 0))
        output, _ = self.run_fresco("retrain", log, *EXPERIMENT, "--out", self.folder / "again", "--format", "json")
        self.assertEqual(json.loads(output)["weights_crc32c"], summary["weights_crc32c"])

    def test_do_not_reach_programs_that_begin_to_listen_to_all_channels(self):
        flood = self.begin_flood()
        large, end_player = self.play_a_large_message()
        log = self.folder / "log"
        recorder = self.start("log", "record", "--lcm-url", url(RECORDED_PORT), "--out", log)
        wait_until(lambda: log.exists() and log.stat().st_size > 3_000_000, "three large messages in the log")
        recorder.send_signal(signal.SIGTERM)
        output, errors = recorder.communicate(timeout=60)
        self.assertEqual(recorder.returncode, 0, errors)
        self.assertRegex(output + errors, r"\d{3} packets")
        self.expect_nothing_hostile(list(read_log(log)), large)
        lines, _ = self.run_fresco("log", "cat", url(RECORDED_PORT), "--seconds", PATIENCE)
        self.assertEqual({json.loads(line)["channel"] for line in lines.splitlines()} - {"LCM_SELF_TEST"}, {"LARGE"})
        info = json.loads(self.run_fresco("log", "info", url(RECORDED_PORT), "--seconds", PATIENCE, "--format", "json")[0])
        self.assertEqual({entry["channel"] for entry in info["channels"]} - {"LCM_SELF_TEST"}, {"LARGE"})
        end_player()
        self.end_flood(flood)


if __name__ == "__main__":
    sys.exit(unittest.main())
