"""A flood of hostile packets on the port of a run: counted, bounded in memory and log, and without a trace in the weights."""
import pathlib
import re
import subprocess
import sys
import unittest

from fresco_process import CI_CONFIG, PATIENCE, FrescoTest, actors_on, url
from hostile_packets import Flood, Recorder, hostile_packets

PORT = 17380
PACKETS_PER_S = 25_000
MORE_MEMORY_MB = 150
SETTINGS = ("--config", CI_CONFIG, "--lcm-url", url(PORT), "--set", "schedule.episodes=1500",
            "--set", "run.optimum_limit_s=0")


def peak_mb(pid):
    try:
        found = re.search(r"VmHWM:\s+(\d+) kB", pathlib.Path(f"/proc/{pid}/status").read_text())
    except OSError:
        found = None
    return int(found[1]) / 1e3 if found else 0


class HostileTraffic(FrescoTest):
    def begin(self, name, *arguments):
        return self.start("train", *SETTINGS, "--out", self.folder / name, "--format", "json", *arguments)

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


if __name__ == "__main__":
    sys.exit(unittest.main())
