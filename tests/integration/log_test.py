"""`fresco log` and `fresco train --record` with real processes; logs are read by a parser of the test's own."""
import csv
import json
import os
import pathlib
import signal
import struct
import subprocess
import time
import unittest
from collections import Counter

from fresco_process import FrescoTest, url, wait_until

SETTINGS = ("--set", "schedule.episodes=60", "--set", "run.optimum_limit_s=0")
SYNC = 0xEDA1DA01


def events_of(path):
    """(utime, channel, message) of every whole event. The format stands in LCM's documentation."""
    data = pathlib.Path(path).read_bytes()
    position, events = 0, []
    while position + 28 <= len(data):
        sync, _, utime, channel_size, size = struct.unpack_from(">IqqII", data, position)
        assert sync == SYNC, f"no event at byte {position}"
        begin = position + 28
        end = begin + channel_size + size
        if end > len(data):
            break
        events.append((utime, data[begin:begin + channel_size].decode(), data[begin + channel_size:end]))
        position = end
    return events


def log_bytes(events):
    return b"".join(struct.pack(">IqqII", SYNC, number, utime, len(channel), len(message)) + channel.encode() + message
                    for number, (utime, channel, message) in enumerate(events))


def messages(events, *channels):
    return [message for _, channel, message in events if not channels or channel in channels]


FIELDS = ("column", "row", "time_margin", "energy_margin_j", "aoi_1", "aoi_2", "aoi_3")  # with three sensors
MOVES = ("north", "south", "east", "west", "hover")


def action_name(action):
    """With three sensors: a move, and which of them transmits."""
    return MOVES[action // 4] + (f", sensor {action % 4}" if action % 4 else "")


def parse_transitions(message):
    """The rows of a transitions_t, field by field as msgs/lcm/transitions_t.lcm lists them."""
    position = 8

    def take(code, count=None):
        nonlocal position
        values = struct.unpack_from(f">{1 if count is None else count}{code}", message, position)
        position += struct.calcsize(f">{len(values)}{code}")
        return values[0] if count is None else list(values)

    utime, run_id, _ = take("q", 3)
    transitions, states, fields, mask_size = take("i", 4)
    assert (states, fields, mask_size) == (transitions + 1, len(FIELDS), 3)
    order_index, actor_id, seed = take("q", 3)
    first, first_field = take("i", 2)
    ending = take("b")
    assert first_field == 0
    state = [take("f", fields) for _ in range(states)]
    action, reward, td_error = take("h", transitions), take("f", transitions), take("f", transitions)
    masks = [take("B", mask_size) for _ in range(transitions)]
    assert position == len(message) - 4, "the CRC stands behind"
    for i in range(transitions):
        allowed = [a for a in range(5 * 4) if masks[i][a // 8] >> a % 8 & 1]
        yield {"utime": utime, "run_id": f"{run_id:016x}", "order_index": order_index, "actor_id": actor_id,
               "seed": seed, "transition": first + i,
               "ending": ("none", "terminal", "truncated")[ending if i + 1 == transitions else 0],
               **dict(zip(FIELDS, state[i])), "action": action[i], "action_name": action_name(action[i]),
               "reward": reward[i], "td_error": td_error[i],
               **{"next_" + name: value for name, value in zip(FIELDS, state[i + 1])},
               "next_allowed_actions": " ".join(map(str, allowed))}


def float32(text):
    return struct.unpack(">f", struct.pack(">f", float(text)))[0]


class Recorded(FrescoTest):
    """Logs of one short run: by `train --record`, and by LCM's own logger beside it."""

    def record_a_run(self, port, *arguments):
        logged = self.folder / "logger.lcm"
        logger = self.start_command(["lcm-logger", "--lcm-url=" + url(port) + "&recv_buf_size=4194304", logged])
        wait_until(logged.exists, "lcm-logger")
        summary = self.train(port, "run", "--record", *SETTINGS, *arguments)
        logger.send_signal(signal.SIGINT)
        logger.communicate(timeout=30)
        return summary, self.folder / "run" / "traffic.lcm", logged

    def info(self, *logs):
        return json.loads(self.run_fresco("log", "info", *logs, "--format", "json")[0])

    def recorder(self, port, out, *arguments):
        process = self.start("log", "record", "--lcm-url", url(port), "--out", out, *arguments)
        self.assertIn("recording", process.stdout.readline())
        return process

    def stop(self, process):
        process.send_signal(signal.SIGTERM)
        output, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0, errors)
        return output


class Log(Recorded):
    def test_train_records_every_message_of_the_run(self):
        summary, log, logged = self.record_a_run(7810)
        events = events_of(log)
        info = self.info(log)
        self.assertEqual(info["events"], len(events))
        self.assertEqual(info["bytes"], log.stat().st_size)
        channels = Counter(channel for _, channel, _ in events)
        self.assertEqual({entry["channel"]: entry["events"] for entry in info["channels"]}, dict(channels))
        self.assertEqual((info["damaged_bytes"], info["torn_bytes"], info["damaged_messages"]), (0, 0, 0))
        [run] = info["runs"]
        self.assertEqual(run["run_id"], summary["run_id"])
        self.assertEqual(run["config_hash"], summary["config_hash"])
        self.assertTrue(run["config_known"])
        self.assertTrue(run["finished"])
        self.assertEqual((run["episodes_partial"], run["orders_without_transitions"]), (0, 0))
        self.assertEqual(run["episodes_whole"], run["last_order"] + 1)
        self.assertGreaterEqual(run["transitions"], summary["transitions"])  # evaluations beside training
        rows = {(row["order_index"], row["transition"]) for message in messages(events, "FRESCO_TRANSITIONS")
                for row in parse_transitions(message)}
        self.assertEqual(run["transitions"], len(rows))
        self.assertEqual([actor["missing"] for actor in info["actors"]], [0, 0])
        said = (self.folder / "run" / "recorder.log").read_text()
        for word in ("LOST", "DROPPED", "REFUSED", "INCOMPLETE"):
            self.assertNotIn(word, said)
        # What LCM's own logger has beside it is the same, but for what it missed.
        [logged_run] = self.info(logged)["runs"]
        self.assertEqual(logged_run["run_id"], run["run_id"])
        fresco = [channel for channel in channels if channel.startswith("FRESCO")]
        self.assertEqual(Counter(messages(events_of(logged), *fresco)) - Counter(messages(events, *fresco)), Counter())

    def test_lcm_logplayer_plays_what_was_recorded(self):
        _, log, _ = self.record_a_run(7811)
        again = self.folder / "again.lcm"
        recorder = self.recorder(7812, again)
        subprocess.run(["lcm-logplayer", "--lcm-url=" + url(7812), log], check=True, timeout=120,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.stop(recorder)
        of_the_run = [event for event in events_of(log) if event[1].startswith("FRESCO")]
        played = [event for event in events_of(again) if event[1].startswith("FRESCO")]
        self.assertEqual([event[1:] for event in played], [event[1:] for event in of_the_run])

    def test_plays_at_full_speed_without_loss_and_records_only_what_is_asked_for(self):
        events = [(10**15 + i * 10**6, f"CHANNEL_{i % 3}", bytes([i % 256]) * (i % 1400)) for i in range(20_000)]
        log, again = self.folder / "made.lcm", self.folder / "again.lcm"
        log.write_bytes(log_bytes(events))
        recorder = self.recorder(7813, again, "--channel", "CHANNEL_[01]", "--split-mb", 3)
        self.run_fresco("log", "play", log, "--speed", 0, "--lcm-url", url(7813))
        self.assertIn(" files", self.stop(recorder))
        parts = sorted(self.folder.glob("again.lcm.*"))
        self.assertGreater(len(parts), 2)
        self.assertEqual(messages([event for part in parts for event in events_of(part)]),
                         messages(events, "CHANNEL_0", "CHANNEL_1"))

    def test_plays_in_the_time_in_which_it_was_recorded_or_faster(self):
        events = [(10**15 + i * 100_000, "A", b"%d" % i) for i in range(20)]
        log, again = self.folder / "made.lcm", self.folder / "again.lcm"
        log.write_bytes(log_bytes(events))
        recorder = self.recorder(7814, again)
        begin = time.monotonic()
        self.run_fresco("log", "play", log, "--start", 0.5, "--stop", 1.5, "--speed", 0.5, "--lcm-url", url(7814))
        self.assertGreaterEqual(time.monotonic() - begin, 1.8)
        self.stop(recorder)
        played = [event for event in events_of(again) if event[1] == "A"]
        self.assertEqual(messages(played), messages(events[5:15]))
        self.assertGreaterEqual(played[-1][0] - played[0][0], 1_750_000)

    def test_exports_every_bit(self):
        _, log, _ = self.record_a_run(7815)
        expected = [row for message in messages(events_of(log), "FRESCO_TRANSITIONS")
                    for row in parse_transitions(message)]
        output, _ = self.run_fresco("log", "export", log)
        table = list(csv.DictReader(output.splitlines()))
        self.assertEqual(len(table), len(expected))
        self.assertEqual(list(table[0]), list(expected[0]), "the columns")
        for row, wanted in zip(table, expected):
            for name, value in wanted.items():
                found = float32(row[name]) if isinstance(value, float) else type(value)(row[name])
                self.assertEqual(found, value, name)
        self.run_fresco("log", "export", log, "--format", "jsonl", "--out", self.folder / "rows.jsonl")
        lines = (self.folder / "rows.jsonl").read_text().splitlines()
        self.assertEqual(len(lines), len(expected))
        for line, wanted in zip(lines, expected):
            row = json.loads(line)
            for name, value in wanted.items():
                self.assertEqual(float32(row[name]) if isinstance(value, float) else row[name], value, name)
        statuses = list(csv.DictReader(self.run_fresco("log", "export", log, "--what", "learner-statuses")[0].splitlines()))
        self.assertEqual(len(statuses), len(messages(events_of(log), "FRESCO_LEARNER_STATUS")))

    def test_prints_events_as_lines_of_json(self):
        _, log, _ = self.record_a_run(7816)
        events = events_of(log)
        lines = [json.loads(line) for line in self.run_fresco("log", "cat", log)[0].splitlines()]
        self.assertEqual([(line["utime"], line["channel"]) for line in lines], [event[:2] for event in events])
        for line, (_, channel, message) in zip(lines, events):
            if channel == "FRESCO_TRANSITIONS":
                rows = list(parse_transitions(message))
                decoded = line["message"]
                self.assertEqual(decoded["action"], [row["action"] for row in rows])
                self.assertEqual([float32(value) for value in decoded["reward"]], [row["reward"] for row in rows])
        parts = [line["message"] for line in lines if line["type"] == "run_t"]
        text = "".join(part["part"] for part in parts[:parts[0]["part_count"]])
        self.assertIn("scenario", text)

    def test_cuts_by_time_channel_and_run_and_keeps_what_is_foreign(self):
        summary, log, _ = self.record_a_run(7817)
        events = events_of(log)
        foreign = [(events[i][0], "CAMERA", b"picture %d" % i) for i in range(0, len(events), 10)]
        mixed = sorted(events + foreign, key=lambda event: event[0])
        (self.folder / "mixed.lcm").write_bytes(log_bytes(mixed))

        def cut(name, *arguments):
            self.run_fresco("log", "cut", self.folder / "mixed.lcm", "--out", self.folder / name, *arguments)
            return events_of(self.folder / name)
        self.assertEqual(cut("all"), mixed)
        begin = mixed[0][0]
        self.assertEqual(cut("time", "--start", 0.3, "--stop", 0.6),
                         [event for event in mixed if 300_000 <= event[0] - begin < 600_000])
        self.assertEqual(cut("channel", "--channel", "CAM.*", "--channel", "FRESCO_ORDERS"),
                         [event for event in mixed if event[1] in ("CAMERA", "FRESCO_ORDERS")])
        self.assertEqual(cut("drop", "--drop", "FRESCO_WEIGHTS_.*"),
                         [event for event in mixed if not event[1].startswith("FRESCO_WEIGHTS")])
        self.assertEqual(cut("of-the-run", "--run", summary["run_id"]), mixed)
        others = cut("other", "--run", "1")
        self.assertEqual([event for event in others if event[1] == "CAMERA"], foreign)
        self.assertNotIn("FRESCO_TRANSITIONS", {event[1] for event in others})
        info = self.info(self.folder / "mixed.lcm")
        self.assertIn("foreign 70696374", next(entry["type"] for entry in info["channels"]
                                               if entry["channel"] == "CAMERA"))
        _, errors = self.run_fresco("log", "cut", self.folder / "mixed.lcm", "--out", log, expect=2)
        self.assertIn("written over", errors)

    def test_reads_torn_and_damaged_logs_and_says_so(self):
        _, log, _ = self.record_a_run(7818)
        data, events = log.read_bytes(), events_of(log)
        torn, damaged = self.folder / "torn.lcm", self.folder / "damaged.lcm"
        torn.write_bytes(data[:-5])
        sixth = len(log_bytes(events[:5]))
        damaged.write_bytes(data[:sixth + 1] + b"\0" + data[sixth + 2:])
        for path, word in ((torn, "cut short"), (damaged, "damaged")):
            output, errors = self.run_fresco("log", "info", path, "--format", "json")
            self.assertIn(word, errors)
            self.assertEqual(json.loads(output)["events"], len(events) - 1)
        _, errors = self.run_fresco("log", "info", self.folder / "none", expect=2)
        self.assertIn("none", errors)

    def test_counts_what_is_missing(self):
        _, log, _ = self.record_a_run(7819)
        events = events_of(log)
        kept, dropped, count = [], [], 0
        for event in events:
            count += event[1] == "FRESCO_TRANSITIONS"
            (dropped if event[1] == "FRESCO_TRANSITIONS" and count % 7 == 0 else kept).append(event)
        statuses = [event for event in kept if event[1] == "FRESCO_ACTOR_STATUS"]
        kept.remove(statuses[len(statuses) // 2])
        (self.folder / "holes.lcm").write_bytes(log_bytes(kept))

        def rows(of):
            return {(row["order_index"], row["transition"]) for message in messages(of, "FRESCO_TRANSITIONS")
                    for row in parse_transitions(message)}
        [run] = (info := self.info(self.folder / "holes.lcm"))["runs"]
        missing = rows(events) - rows(kept)
        self.assertEqual(run["transitions"], len(rows(kept)))
        self.assertEqual(run["episodes_partial"] + run["orders_without_transitions"],
                         len({order for order, _ in missing}))
        self.assertLessEqual(run["transitions_missing"], len(missing))
        self.assertGreater(run["transitions_missing"], 0)
        self.assertEqual(sum(actor["missing"] for actor in info["actors"]), 1)

    def test_listens_to_a_bus_as_it_reads_a_log(self):
        events = [(10**15 + i * 10_000, "A", b"%d" % i) for i in range(30)]
        log = self.folder / "made.lcm"
        log.write_bytes(log_bytes(events))
        player = self.start("log", "play", log, "--loop", "--lcm-url", url(7820))
        output, _ = self.run_fresco("log", "cat", url(7820), "--seconds", 1, "--channel", "A")
        player.send_signal(signal.SIGTERM)
        self.assertEqual(player.wait(30), 0)
        lines = [json.loads(line) for line in output.splitlines()]
        self.assertGreater(len(lines), 10)
        self.assertEqual({line["type"] for line in lines}, {None})

    def test_a_resumed_run_is_recorded_under_the_next_free_name(self):
        folder = self.folder / "run"
        process = self.start("train", "--config", "configs/ci.textproto", "--lcm-url", url(7821), "--out", folder,
                             "--record", "--set", "schedule.episodes=1000000", cwd=pathlib.Path(__file__).parents[2])
        wait_until(lambda: self.evaluations("run") > 0, "a first evaluation")
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1, errors)
        self.assertIn("--record", errors)
        first = (folder / "traffic.lcm").read_bytes()
        process = self.start("train", "--resume", folder, "--record")
        wait_until(lambda: (folder / "traffic-2.lcm").exists() and (folder / "traffic-2.lcm").stat().st_size > 10_000,
                   "a second log")
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=60)
        self.assertIn("traffic-2.lcm", output)
        self.assertEqual((folder / "traffic.lcm").read_bytes(), first)
        self.assertEqual(len({run["run_id"] for run in self.info(folder / "traffic.lcm", folder / "traffic-2.lcm")["runs"]}), 1)

    def test_training_goes_on_where_the_recorder_dies_and_does_not_begin_where_it_cannot(self):
        folder = self.folder / "run"
        process = self.start("train", "--config", "configs/ci.textproto", "--lcm-url", url(7822), "--out", folder,
                             "--record", *SETTINGS[:2], "--set", "schedule.episodes=400",
                             cwd=pathlib.Path(__file__).parents[2])
        wait_until(lambda: self.recorders(folder), "the recorder")
        wait_until(lambda: self.learner_of("run"), "the learner")
        [recorder] = self.recorders(folder)
        os.kill(recorder, signal.SIGKILL)
        output, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, errors)
        self.assertIn("INCOMPLETE", output)
        self.assertIn("continues without it", errors)
        bad = self.folder / "bad"
        (bad / "traffic.lcm").mkdir(parents=True)
        (bad / "recorder.log").mkdir()
        _, errors = self.run_fresco("train", "--config", "configs/ci.textproto", "--lcm-url", url(7822), "--out", bad,
                                    "--record", expect=1, cwd=pathlib.Path(__file__).parents[2])
        self.assertIn("recorder.log", errors)
        self.assertFalse((bad / "learner.log").exists())

    @staticmethod
    def recorders(folder):
        found = []
        for entry in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                arguments = (entry / "cmdline").read_text().split("\0")
            except OSError:
                continue
            if "record" in arguments and any(argument.startswith(str(folder)) for argument in arguments):
                found.append(int(entry.name))
        return found

    def test_a_full_disk_is_an_error_and_what_was_written_can_be_read(self):
        disk = self.folder / "disk"
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", disk], capture_output=True)
        if mounted.returncode != 0:
            self.skipTest("needs the right to mount a file system: " + mounted.stderr.decode())
        self.addCleanup(lambda: subprocess.run(["umount", disk], check=True))
        log = self.folder / "made.lcm"
        log.write_bytes(log_bytes([(10**15 + i, "A", bytes(1000)) for i in range(3000)]))
        recorder = self.recorder(7823, disk / "log")
        self.run_fresco("log", "play", log, "--speed", 0, "--lcm-url", url(7823))
        output, errors = recorder.communicate(timeout=60)
        self.assertEqual(recorder.returncode, 1, output)
        self.assertIn("No space left on device", errors)
        self.assertGreater(len(events_of(disk / "log")), 900)


if __name__ == "__main__":
    unittest.main()
