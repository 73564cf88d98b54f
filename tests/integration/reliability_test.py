"""The same weights, whatever happens: one table of disturbances and final weights, with real processes over real LCM.

Alone: FRESCO_BIN=build/release/bin python3 tests/integration/reliability_test.py [--all] [--table FILE]
"""
import argparse
import os
import pathlib
import signal
import sys
import time
import unittest

from fresco_process import CI_CONFIG, PATIENCE, FrescoTest, actors_on, url, wait_until
from hostile_packets import Flood, Recorder, hostile_packets, identity_of, parts

PORT = 17360
SETTINGS = ("--config", CI_CONFIG, "--lcm-url", url(PORT), "--set", "schedule.episodes=1500",
            "--set", "run.optimum_limit_s=0", "--set", "run.checkpoint_interval_s=0.2")
FLOOD_PER_S = 25_000
REPLAYED_PER_S = 5_000
RECORDED_US = 10_000_000  # kClockToleranceUs in msgs/protocol_times.h
OFTEN, ONCE = "every version evaluated", "the last version alone evaluated"
# Other tests compare the weights under these as well, so they are in the table only with --all.
ELSEWHERE = {"the learner killed": "resume_test.py", "a flood of hostile packets": "hostile_traffic_test.py"}
table_file, every_disturbance = None, False


class Reliability(FrescoTest):
    def begin(self, name, *arguments):
        return self.start("train", *SETTINGS, "--out", self.folder / name, "--format", "json", *arguments)

    # ---- Disturbances: each returns the summary, and what was injected and counted besides.

    def with_options(self, *arguments):
        return self.summary_of(self.begin("-".join(map(str, arguments)).strip("-"), *arguments)), ""

    def with_actors_signalled(self, signals, period_s, rest_s=0.0):
        """Sends the signals to one actor after the other: the first at once, further ones `period_s` later each."""
        name = "-".join(map(str, map(int, signals)))
        process = self.begin(name)
        count = 0
        while process.poll() is None:
            actors = actors_on(PORT)
            for number in signals if actors else ():
                try:
                    os.kill(actors[count % len(actors)], number)
                except ProcessLookupError:
                    pass
                time.sleep(period_s * PATIENCE)  # the moments of the fault
            count += len(actors) > 0
            time.sleep(rest_s * PATIENCE or 0.01)
        summary = self.summary_of(process)
        self.assertGreater(count, 0)
        return summary, f"{count} times"

    def kill_learner(self, name, process):
        before = self.evaluations(name)
        wait_until(lambda: self.evaluations(name) > before + 3, "evaluations")
        os.kill(self.learner_of(name), signal.SIGKILL)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)

    def resume(self, name, *arguments):
        return self.start("train", "--resume", self.folder / name, "--format", "json", *arguments)

    def with_learner_killed(self):
        process, recoveries_s = self.begin("killed"), []
        for _ in range(3):
            self.kill_learner("killed", process)
            begin, before = time.monotonic(), self.evaluations("killed")
            process = self.resume("killed")
            wait_until(lambda: self.evaluations("killed") > before or process.poll() is not None, "it to catch up")
            recoveries_s.append(time.monotonic() - begin)
        summary = self.summary_of(process)
        self.assertEqual(summary["resumptions"], 3)
        return summary, f"3 times; further than before within {max(recoveries_s):.1f} s"

    def with_foreign_run(self):
        """The other run's learner keeps still while this run's looks whether the bus is free."""
        other = self.begin("other", "--seed", 2, "--set", "schedule.episodes=1000000")
        self.wait_for_evaluation("other")
        stopped = self.learner_of("other")
        os.kill(stopped, signal.SIGSTOP)
        try:
            process = self.begin("beside")
            self.wait_for_evaluation("beside")
        finally:
            os.kill(stopped, signal.SIGCONT)
        before = self.evaluations("other")
        summary = self.summary_of(process)
        self.assertGreater(self.evaluations("other"), before, "the other run goes on, too")
        other.send_signal(signal.SIGINT)
        other.communicate(timeout=60)
        self.assertGreater(summary["bus"]["rejected_foreign"], 0)
        return summary, "its messages rejected"

    def with_flood(self):
        recorder = Recorder(PORT)
        self.summary_of(self.begin("recorded", "--set", "schedule.episodes=60"))
        recorded = recorder.end()
        process = self.begin("flooded")
        self.wait_for_evaluation("flooded")
        flood = Flood(PORT, hostile_packets(recorded, self.run_id("flooded")), FLOOD_PER_S)
        summary = self.summary_of(process)
        counts, per_s = flood.end()
        self.assertGreater(summary["bus"]["rejected_malformed"], 0)
        self.assertGreater(summary["bus"]["rejected_foreign"], 0)
        return summary, f"{sum(counts.values())} packets, {per_s:.0f} a second"

    def with_replay(self):
        """Everything of the run's first part is sent again and again while it goes on from a checkpoint."""
        key = self.key()
        recorder = Recorder(PORT)
        process = self.begin("replayed", "--key-file", key)
        self.kill_learner("replayed", process)
        recorded = recorder.end()
        before = self.evaluations("replayed")
        process = self.resume("replayed", "--key-file", key)
        wait_until(lambda: self.evaluations("replayed") > before or process.poll() is not None, "it to go on")
        replay = Flood(PORT, [("recorded", datagram) for datagram in recorded], REPLAYED_PER_S)
        summary = self.summary_of(process)
        counts, _ = replay.end()
        self.assertGreater(summary["bus"]["stale_statuses"], 0)
        return summary, f"{sum(counts.values())} packets, {summary['bus']['stale_statuses']} statuses stale"

    def with_authentication(self):
        """Recorded for with_earlier_run_replayed."""
        self.earlier_key, recorder = self.key("earlier"), Recorder(PORT)
        summary, injected = self.with_options("--key-file", self.earlier_key)
        self.earlier = recorder.end()
        return summary, injected

    def with_earlier_run_replayed(self):
        """A free actor joins the recording of an earlier run with the same key, before the learner starts beside it."""
        def channel(datagram):
            return parts(datagram)[0]

        # Of the learner only, so that the statuses that are heard are the actor's, and without the run's end.
        last_orders = max(place for place, datagram in enumerate(self.earlier) if channel(datagram) == "FRESCO_ORDERS")
        replayed = [datagram for datagram in self.earlier[:last_orders] if channel(datagram).startswith("FRESCO_")
                    and channel(datagram) not in ("FRESCO_ACTOR_STATUS", "FRESCO_TRANSITIONS")]
        newest_utime = max(identity_of(datagram).utime for datagram in replayed)
        wait_until(lambda: time.time() * 1e6 > newest_utime + RECORDED_US, "the recording to be old")
        recorder, replay = Recorder(PORT), Flood(PORT, [("recorded", datagram) for datagram in replayed], REPLAYED_PER_S)
        actor = self.start("--lcm-url", url(PORT), "--key-file", self.earlier_key, program="fresco-actor")
        earlier_run = identity_of(replayed[0]).run_id
        wait_until(lambda: any(identity_of(datagram).run_id == earlier_run for datagram in list(recorder.datagrams)
                               if channel(datagram) == "FRESCO_ACTOR_STATUS"), "the actor to join the recording")
        recorder.end()
        summary = self.summary_of(self.begin("after", "--key-file", self.earlier_key, "--actors", 0))
        counts, _ = replay.end()
        actor.send_signal(signal.SIGTERM)
        _, log = actor.communicate(timeout=20)
        self.assertEqual(actor.returncode, 0, log)
        self.assertIn(f"leaving run {earlier_run & 0xFFFFFFFFFFFFFFFF:016x}", log)
        return summary, f"{sum(counts.values())} packets"

    def test_gives_the_same_weights_whatever_happens(self):
        disturbances = [
            ("none: 2 actors", lambda: self.with_options("--actors", 2)),
            ("1 actor", lambda: self.with_options("--actors", 1)),
            ("8 actors", lambda: self.with_options("--actors", 8)),
            (OFTEN, lambda: self.with_options("--set", "schedule.versions_per_evaluation=1")),
            (ONCE, lambda: self.with_options("--set", "schedule.versions_per_evaluation=1000000")),
            ("1 % of the messages lost", lambda: self.with_options("--disturb", "drop=0.01,seed=3")),
            ("5 % of the messages lost", lambda: self.with_options("--disturb", "drop=0.05,seed=4")),
            ("10 % twice, 10 % out of order", lambda: self.with_options("--disturb", "duplicate=0.1,delay=0.1,seed=5")),
            ("a bit flipped in 2 %", lambda: self.with_options("--disturb", "corrupt=0.02,seed=6")),
            ("an actor killed every second", lambda: self.with_actors_signalled([signal.SIGKILL], 1.0)),
            ("an actor stopped for 0.5 s, each 0.7 s",
             lambda: self.with_actors_signalled([signal.SIGSTOP, signal.SIGCONT], 0.5, 0.2)),
            ("the learner killed", self.with_learner_killed),
            ("another run on the same channels", self.with_foreign_run),
            ("a flood of hostile packets", self.with_flood),
            ("authentication", self.with_authentication),
            ("authentication, old messages replayed", self.with_replay),
            ("authentication, an earlier run replayed", self.with_earlier_run_replayed)]
        disturbances = [row for row in disturbances if every_disturbance or row[0] not in ELSEWHERE]
        rows = []
        for name, disturb in disturbances:
            with self.subTest(disturbance=name):
                begin = time.monotonic()
                summary, injected = disturb()
                rows.append((name, summary, injected, time.monotonic() - begin))
        text = table(rows)
        print(text, flush=True)
        if table_file:
            pathlib.Path(table_file).write_text(text)
        self.assertEqual(len(rows), len(disturbances))
        for name, summary, *_ in rows:
            # Which version is delivered depends on which ones are evaluated.
            delivered = () if name in (OFTEN, ONCE) else ("total_aoi",)
            for what in ("weights_crc32c", "transitions", "updates", "episodes", *delivered):
                self.assertEqual(summary[what], rows[0][1][what], f"{what}: {name}")


def table(rows):
    lines = [("disturbance", "weights_crc32c", "transitions lost", "asked again", "duplicates", "rejected",
              "seconds", "injected")]
    for name, summary, injected, seconds in rows:
        bus = summary["bus"]
        lines.append((name, summary["weights_crc32c"], rows[0][1]["transitions"] - summary["transitions"], bus["lost"],
                      bus["duplicate"], bus["rejected"], f"{seconds:.1f}", injected))
    widths = [max(len(str(line[i])) for line in lines) for i in range(len(lines[0]))]
    cells = [[str(cell).ljust(width) if column in (0, 1, 7) else str(cell).rjust(width)
              for column, (cell, width) in enumerate(zip(line, widths))] for line in lines]
    return "".join("  ".join(line).rstrip() + "\n" for line in cells)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--table", metavar="FILE", help="write the table to a file, too")
    parser.add_argument("--all", action="store_true", help="have those disturbances too that other tests have")
    known, others = parser.parse_known_args()
    table_file, every_disturbance = known.table, known.all
    sys.exit(unittest.main(argv=[sys.argv[0], *others]))
