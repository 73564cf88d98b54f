"""`fresco train` with real processes over real LCM: the promises of the README."""
import csv
import itertools
import json
import os
import re
import signal
import struct
import subprocess
import sys
import time
import unittest

from hostile_packets import crc32c
from fresco_process import CI_CONFIG, PATIENCE, ROOT, FrescoTest, processes_with, read_log, url, wait_until

SUMMARY_KEYS = {
    "run_id", "config_hash", "seed", "episodes", "transitions", "updates", "wall_s", "updates_per_s",
    "transitions_per_s", "weights_crc32c", "world", "score", "success", "total_aoi", "average_aoi", "sum_aoi", "arrived",
    "optimal_total_aoi", "gap_percent", "baselines", "bus"}

NO_SEARCH = ("--set", "run.optimum_limit_s=0")  # for the exact optimum


def fields_of(message):
    """The fields of an encoded protobuf message: numbers and values, bytes for what has a length."""
    def varint():
        value = shift = 0
        while True:
            byte = next(stream)
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    stream = iter(message)
    take = lambda count: bytes(itertools.islice(stream, count))
    for byte in stream:
        number, kind = byte >> 3, byte & 7  # all numbers here are small
        yield number, (varint() if kind == 0 else struct.unpack("<d", take(8))[0] if kind == 1
                       else take(varint()) if kind == 2 else struct.unpack("<f", take(4))[0])


def read_tensorboard(path):
    """The events of a file as TensorBoard reads it: TFRecords with masked checksums."""
    def masked(data):
        crc = crc32c(data)
        return ((crc >> 15 | crc << 17) + 0xA282EAD8) & 0xFFFFFFFF

    data = path.read_bytes()
    while data:
        length, crc = struct.unpack("<QI", data[:12])
        assert crc == masked(data[:8]), "the checksum of a length"
        event = data[12:12 + length]
        assert struct.unpack("<I", data[12 + length:16 + length])[0] == masked(event), "the checksum of an event"
        data = data[16 + length:]
        yield dict(fields_of(event))


class Train(FrescoTest):
    def test_gives_the_same_weights_with_any_number_of_actors(self):
        proved = self.train(17301, "actors-1", "--actors", 1, "--set", "run.optimum_limit_s=300")
        summaries = [proved] + [self.train(17301, f"actors-{n}", "--actors", n, *NO_SEARCH) for n in (2, 4)]
        self.assertEqual(len({summary["weights_crc32c"] for summary in summaries}), 1)
        for summary in summaries:
            self.assertLessEqual(SUMMARY_KEYS, set(summary))
            self.assertEqual(summary["episodes"], 400)
            self.assertTrue(summary["arrived"])
            updating = summary["updating"]
            self.assertEqual(updating["updates"], summary["updates"] - 1)  # since the first
            self.assertLess(0, updating["training_thread_s"])
            self.assertLessEqual(updating["training_thread_s"], updating["learner_s"])
            processor = summary["processor_s"]
            self.assertLessEqual(updating["learner_s"], processor["learner"])
            self.assertLessEqual(processor["training_thread"] + processor["optimum_search"], processor["learner"])
            self.assertLess(0, processor["actors"])
            self.assertLess(updating["wall_s"], summary["wall_s"])
        self.assertEqual(proved["optimal_total_aoi"], 2789)
        self.assertAlmostEqual(proved["gap_percent"], 100 * (proved["total_aoi"] / 2789 - 1), places=6)
        other = self.train(17301, "seed-2", "--seed", 2, *NO_SEARCH)
        self.assertNotEqual(other["weights_crc32c"], summaries[0]["weights_crc32c"])

    def test_gives_the_same_weights_with_every_arithmetic(self):
        _, refusal = self.run_fresco("train", "--arithmetic", "x87", expect=2)
        names = re.search(r"--arithmetic: expected one that this build has for this processor \((.*)\), found \"x87\"",
                          refusal).group(1).split(", ")
        self.assertIn("portable", names)
        settings = ("--set", "schedule.episodes=150", *NO_SEARCH)
        weights = set()
        for name in names:
            weights.add(self.train(17432, name, "--arithmetic", name, *settings)["weights_crc32c"])
            for process in ("learner", "actor-0"):
                self.assertIn(f"; arithmetic {name}\n", (self.folder / name / f"{process}.log").read_text())
        actors = [self.start("--lcm-url", url(17432), "--once", "--arithmetic", name, program="fresco-actor")
                  for name in names]  # all in one run
        weights.add(self.train(17432, "mixed", "--actors", 0, *settings)["weights_crc32c"])
        self.assertEqual(len(weights), 1)
        for actor, name in zip(actors, names):
            _, log = actor.communicate(timeout=30)
            self.assertIn(f"; arithmetic {name}\n", log)
            self.assertNotIn("serving no run", log)

    def test_gives_the_same_weights_when_actors_are_killed(self):
        settings = ("--set", "schedule.episodes=1000", *NO_SEARCH)
        undisturbed = self.train(17302, "undisturbed", *settings)
        folder = self.folder / "disturbed"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17302), "--out", folder,
                             "--format", "json", *settings)
        killed = 0
        while process.poll() is None:
            for pid in set(processes_with("fresco-actor")) & set(processes_with(url(17302))):
                os.kill(pid, signal.SIGKILL)
                killed += 1
                break
            try:
                process.wait(0.4 * PATIENCE)
            except subprocess.TimeoutExpired:
                pass
        output, errors = process.communicate()
        self.assertEqual(process.returncode, 0, errors)
        self.assertGreater(killed, 0)
        self.assertEqual(json.loads(output)["weights_crc32c"], undisturbed["weights_crc32c"])

    def test_tells_its_state_on_sigusr1_and_goes_on_unharmed(self):
        settings = ("--set", "schedule.episodes=1000", *NO_SEARCH)
        undisturbed = self.train(17431, "unasked", *settings)
        folder = self.folder / "asked"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17431), "--out", folder,
                             "--format", "json", *settings)
        wait_until((folder / "metrics.csv").exists, "a first evaluation")
        asked = set()

        def both_actors_are_in_the_state():
            asked.update(set(processes_with("fresco-learner")) & set(processes_with(str(folder))))
            asked.update(set(processes_with("fresco-actor")) & set(processes_with(url(17431))))
            for pid in asked:
                os.kill(pid, signal.SIGUSR1)
            return "\n  2 actors\n" in (folder / "learner.log").read_text()

        wait_until(both_actors_are_in_the_state, "a state with both actors")
        output, errors = process.communicate()
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(len(asked), 3)
        self.assertEqual(json.loads(output)["weights_crc32c"], undisturbed["weights_crc32c"])
        learner, actor = ((folder / name).read_text() for name in ("learner.log", "actor-0.log"))
        for part in (" info: state\n", " in flight; ", "networks on offer: ", " received, ", "\n  2 actors\n",
                     "heard of 0."):
            self.assertIn(part, learner)
        for part in (" info: state\n", "orders flying", "networks held: ", "versions completed"):
            self.assertIn(part, actor)

    def test_speaks_on_all_channels_in_single_frames(self):
        log = self.folder / "lcm.log"
        logger = subprocess.Popen(["lcm-logger", "--lcm-url=" + url(17303) + "&recv_buf_size=4194304", "-f", log],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            wait_until(log.exists, "lcm-logger")
            self.train(17303, "logged", *NO_SEARCH)
        finally:
            logger.terminate()
            logger.wait(10)
        sizes = {}
        for channel, data in read_log(log):
            if channel != "LCM_SELF_TEST":  # LCM's own, at the start of a program
                sizes[channel] = max(len(data), sizes.get(channel, 0))
        self.assertEqual(set(sizes), {"FRESCO_" + name for name in (
            "RUN", "ORDERS", "TRANSITIONS", "WEIGHTS_CURRENT", "WEIGHTS_TARGET", "ACTOR_STATUS", "LEARNER_STATUS",
            "SCENARIO", "WORLD")})
        self.assertLessEqual(max(sizes.values()), 1350)

    def test_ends_in_order_on_interrupt(self):
        folder = self.folder / "interrupted"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17304), "--out", folder, "--format", "json",
                             "--set", "schedule.episodes=1000000", "--set", "run.optimum_limit_s=300")
        wait_until(lambda: (folder / "metrics.csv").exists() and process.poll() is None, "a first evaluation")
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 1, errors)
        summary = json.loads(output)
        self.assertFalse(summary["completed"])
        self.assertLessEqual({"config.textproto", "metrics.csv", "best.network", "final.network", "optimum.json",
                              "report.html", "summary.json"},
                             {path.name for path in folder.iterdir()})
        self.assertEqual(processes_with(str(folder)) + processes_with(":17304"), [])

    def test_writes_its_metrics_for_other_tools(self):
        self.train(17316, "metrics", *NO_SEARCH)
        folder = self.folder / "metrics"
        with open(folder / "metrics.csv", newline="") as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        self.assertGreater(len(rows), 2)
        self.assertEqual([json.loads(line) for line in (folder / "metrics.jsonl").read_text().splitlines()], rows)
        first, *events = read_tensorboard(folder / "events.out.tfevents.fresco")
        self.assertEqual(first[3], b"brain.Event:2")
        self.assertEqual(len(events), len(rows))
        for event, row in zip(events, rows):
            self.assertEqual(event[2], row["updates"])
            self.assertAlmostEqual(event[1] - first[1], row["wall_s"], places=3)
            self.assertLess(abs(event[1] - time.time()), 3600)
            curves = {}
            for number, value in fields_of(event[5]):
                self.assertEqual(number, 1)
                curve = dict(fields_of(value))
                curves[curve[1].decode()] = curve[2]
            self.assertEqual(len(curves), len(row) - 2)
            self.assertEqual(curves["training/loss"], struct.unpack("f", struct.pack("f", row["loss"]))[0])
            self.assertEqual(curves["evaluation/arrived"], row["arrived"])

    def test_goes_on_until_the_optimum_is_proved(self):
        """The training takes a second, the search for eight sensors several."""
        _, summary = self.train_few_episodes(17310, "eight", 8, "run.optimum_limit_s=900")
        self.assertEqual((summary["optimum_search"], summary["episodes"]), ("proved", 20))
        self.assertEqual(summary["best_found_total_aoi"], summary["optimal_total_aoi"])
        if summary["arrived"]:
            gap = 100 * (summary["total_aoi"] / summary["optimal_total_aoi"] - 1)
            self.assertAlmostEqual(summary["gap_percent"], gap, places=6)

    def test_has_no_gap_to_an_optimum_that_is_not_proved(self):
        output, summary = self.train_few_episodes(17312, "unproved", 40, "run.optimum_limit_s=0.3", form="text")
        self.assertEqual(summary["optimum_search"], "limit")
        for field in ("gap_percent", "optimal_total_aoi", "optimal_average_aoi"):
            self.assertIsNone(summary[field], field)
        self.assertLessEqual(summary["lower_bound_average_aoi"], summary["best_found_average_aoi"])
        page = (self.folder / "unproved" / "report.html").read_text()
        for text in (output, page):
            self.assertIn("not proved", text)
            self.assertIn("The exact optimum is not proved: the search reached run.optimum_limit_s", text)
            self.assertIn("best flight of the search", text)

    def test_is_complete_when_it_is_stopped_while_it_waits_for_the_proof_which_goes_on_later(self):
        errors = self.folder / "errors"
        with open(errors, "w") as file:
            process = self.start(*self.few_episodes(17311, "stopped", 40, "run.optimum_limit_s=3600"), "--format",
                                 "json", stderr=file)
        waits = r"trained, waits for the proof of the exact optimum: at most \d+ s more of processor time"
        wait_until(lambda: re.search(waits, errors.read_text()), "the end of the training")
        process.send_signal(signal.SIGINT)
        output, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, errors.read_text())
        stopped = json.loads(output)
        self.assertEqual((stopped["completed"], stopped["optimum_search"]), (True, "stopped"))
        self.assertIsNone(stopped["gap_percent"])
        self.assertIn("--resume", errors.read_text())
        resume = ("train", "--resume", self.folder / "stopped", "--format", "json", "--set", "run.optimum_limit_s=0.3")
        output, _ = self.run_fresco(*resume)
        resumed = json.loads(output)
        self.assertEqual((resumed["completed"], resumed["optimum_search"], resumed["resumptions"]), (True, "limit", 1))
        for field in ("weights_crc32c", "updates", "total_aoi"):
            self.assertEqual(resumed[field], stopped[field], field)
        self.run_fresco(*resume, expect=2)

    def few_episodes(self, port, name, sensors, setting):
        config = self.folder / f"{name}.textproto"
        config.write_text(f"scenario {{ random_sensors {{ count: {sensors} seed: 3 }} }} agent {{ safe_action_mask: "
                          "true hidden_layers: 16 } schedule { episodes: 20 minimum_replay_size: 500 "
                          "inserts_per_update: 4 }")
        return ("train", "--config", config, "--lcm-url", url(port), "--out", self.folder / name, "--set", setting)

    def train_few_episodes(self, port, name, sensors, setting, form="json"):
        output, _ = self.run_fresco(*self.few_episodes(port, name, sensors, setting), "--format", form)
        return output, json.loads((self.folder / name / "summary.json").read_text())

    def test_leaves_no_process_behind_when_it_is_killed(self):
        folder = self.folder / "killed"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17305), "--out", folder,
                             "--set", "schedule.episodes=1000000")
        wait_until(lambda: len(processes_with(":17305")) >= 3, "the actors")
        process.kill()
        process.communicate()
        wait_until(lambda: not processes_with(str(folder)) and not processes_with(":17305"), "the processes to end")

    def test_serves_actors_that_are_there_before_and_after_a_learner(self):
        actor = self.start("--lcm-url", url(17306), program="fresco-actor")
        try:
            first = self.train(17306, "first", "--actors", 0, *NO_SEARCH)
            second = self.train(17306, "second", "--actors", 0, *NO_SEARCH)
            self.assertEqual(first["weights_crc32c"], second["weights_crc32c"])
        finally:
            actor.send_signal(signal.SIGTERM)
            actor.communicate(timeout=10)
        self.assertEqual(actor.returncode, 0)

    def test_runs_every_ready_experiment(self):
        configs = sorted((ROOT / "configs").glob("*.textproto"))
        self.assertGreaterEqual(len(configs), 4)
        for config in configs:
            summary = self.train(17308, config.stem, "--set", "schedule.episodes=12", "--set",  # some are short
                                 "schedule.minimum_replay_size=100", *NO_SEARCH, config=config)
            self.assertEqual(summary["episodes"], 12, config)
            self.assertGreater(summary["updates"], 0, config)

    def test_gives_up_on_a_learner_that_is_silent(self):
        folder = self.folder / "silent"
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17309), "--out", folder,
                             "--set", "schedule.episodes=1000000", "--set", "run.patience_s=4")
        wait_until(lambda: (folder / "metrics.csv").exists(), "a first evaluation")
        [learner] = set(processes_with("fresco-learner")) & set(processes_with(str(folder)))
        os.kill(learner, signal.SIGSTOP)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("nothing was heard of the learner", errors)
        self.assertIn("run.patience_s", errors)
        wait_until(lambda: not processes_with(str(folder)), "the learner to be ended")

    def test_refuses_a_port_that_another_run_uses(self):
        first = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17307), "--out", self.folder / "first",
                           "--set", "schedule.episodes=1000000")
        try:
            wait_until(lambda: len(processes_with(":17307")) >= 3, "the first run")
            _, errors = self.run_fresco("train", "--config", CI_CONFIG, "--lcm-url", url(17307), "--out",
                                        self.folder / "second", expect=2)
            self.assertIn("--lcm-url", errors)
        finally:
            first.send_signal(signal.SIGINT)
            first.communicate(timeout=30)


if __name__ == "__main__":
    sys.exit(unittest.main())
