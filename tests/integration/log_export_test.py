"""What other programs read of a recorded run: `fresco log export` to MCAP, read by npm's packages, and to a folder of
tables, read by Python's csv; the Python module fresco_log; `fresco log repair`. All against `fresco log cat`."""
import csv
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import unittest

from fresco_process import ROOT, FrescoTest

HERE = pathlib.Path(__file__).resolve().parent
MODULES = pathlib.Path(os.environ["FRESCO_BUILD"]) / "lib/python3/dist-packages"
sys.path.insert(0, str(MODULES))
import fresco_log  # noqa: E402 (the build's)

NPM_PACKAGES = ["@mcap/core@2.2.2", "@mcap/support@1.1.0"]
HEADER = struct.Struct(">IqqII")


def event_bytes(utime, channel, message):
    """The format stands in LCM's documentation."""
    name = channel.encode()
    return HEADER.pack(0xEDA1DA01, 0, utime, len(name), len(message)) + name + message


def float32(value):
    return struct.unpack(">f", struct.pack(">f", value))[0]


class LogExport(FrescoTest):
    def record(self, port):
        """A log with the messages of a run, a foreign one and a damaged one, and what `log cat` shows of it."""
        self.train(port, "run", "--record", "--set", "schedule.episodes=60", "--set", "run.optimum_limit_s=0")
        self.log = self.folder / "run" / "traffic.lcm"
        events = list(fresco_log.EventLog(self.log))
        last = events[-1]
        status = next(event.data for event in events if event.channel == "FRESCO_LEARNER_STATUS")
        with open(self.log, "ab") as log:
            log.write(event_bytes(last.utime + 1, "CAMERA", b"picture"))
            log.write(event_bytes(last.utime + 2, "FRESCO_LEARNER_STATUS", status[:90] + b"?" + status[91:]))
        self.lines = self.cat(self.log)
        self.sound = [line for line in self.lines if "message" in line]
        self.assertEqual(len(self.sound), sum(1 for event in events if event.type))

    def cat(self, *arguments):
        return [json.loads(line) for line in self.run_fresco("log", "cat", *arguments)[0].splitlines()]

    def assert_same(self, found, wanted, where):
        """`wanted` is from `log cat`: numbers with the fewest digits that tell their bits, null for NaN."""
        if isinstance(wanted, dict):
            self.assertEqual(set(found), set(wanted), where)
            for name in wanted:
                self.assert_same(found[name], wanted[name], f"{where}.{name}")
        elif isinstance(wanted, list):
            self.assertEqual(len(found), len(wanted), where)
            for i, value in enumerate(wanted):
                self.assert_same(found[i], value, f"{where}[{i}]")
        elif isinstance(wanted, float):
            self.assertIn(found, (wanted, float32(wanted)), where)
        elif wanted is None:
            self.assertTrue(found is None or math.isnan(found), where)
        elif isinstance(wanted, int):
            self.assertEqual(int(found), wanted, where)  # JavaScript has 64 bits only as a text
        else:
            self.assertEqual(found, wanted, where)

    def test_mcap_is_what_other_programs_read(self):
        if not shutil.which("npm"):
            self.skipTest("MCAP's own packages are installed by npm, which is not there")
        self.record(7830)
        installed = subprocess.run(["npm", "install", "--prefix", self.folder, "--no-audit", "--no-fund",
                                    "--fetch-retries=1", "--fetch-retry-mintimeout=1000", *NPM_PACKAGES],
                                   capture_output=True, text=True)
        if installed.returncode != 0:
            self.skipTest(f"npm can't install {' '.join(NPM_PACKAGES)}: {installed.stderr.strip()}")

        def export(*arguments, log=self.log, channel=".*"):
            out = self.folder / "run.mcap"
            output, errors = self.run_fresco("log", "export", log, *arguments, "--channel", channel, "--format", "mcap",
                                             "--out", out)
            self.said = output + errors
            read = subprocess.run(["node", HERE / "read_mcap.mjs", self.folder / "node_modules", out], check=True,
                                  capture_output=True, text=True)
            return json.loads(read.stdout)
        found = export()
        self.assertIn("1 messages are damaged and were left out", self.said)
        self.assertRegex(self.said, r"\d events have messages of unknown types and were left out.*CAMERA")
        count = len(self.sound)
        self.assertEqual((found["statistics"], found["streamed"], found["done"]), (count, count, True))
        self.assertEqual(sorted(found["topics"]), sorted({line["channel"] for line in self.sound}))
        # Messages of the same microsecond come channel by channel.
        found["messages"].sort(key=lambda message: (int(message["logTime"]), message["topic"]))
        lines = sorted(self.sound, key=lambda line: (line["utime"], line["channel"]))
        for message, line in zip(found["messages"], lines, strict=True):
            self.assertEqual((message["topic"], message["type"]), (line["channel"], line["type"]))
            self.assertEqual(message["encodings"], ["protobuf", "protobuf"])
            self.assertEqual(message["logTime"], str(1000 * line["utime"]))
            self.assertEqual(message["publishTime"], str(1000 * line["message"]["utime"]))
            self.assert_same(message["message"], line["message"], line["type"])
        for topic in found["topics"]:
            numbers = [message["sequence"] for message in found["messages"] if message["topic"] == topic]
            self.assertEqual(numbers, list(range(len(numbers))))
        states = [message["message"]["state"] for message in found["messages"] if message["type"] == "transitions_t"]
        self.assertIn("column", states[0][0])
        # The selection is that of the other commands; the names come from the whole log.
        selected = export("--stop", 1e6, channel="FRESCO_TRANSITIONS")
        self.assertEqual(selected["topics"], ["FRESCO_TRANSITIONS"])
        self.assertEqual([message["message"]["state"] for message in selected["messages"]], states)
        # Without names, a state is a list. Transitions of another world have a channel of their own.
        self.run_fresco("log", "cut", self.log, "--drop", "FRESCO_WORLD", "--out", self.folder / "nameless")
        nameless = export(log=self.folder / "nameless", channel="FRESCO_TRANSITIONS")
        self.assertEqual([message["message"]["state"] for message in nameless["messages"]],
                         [[{"value": list(state.values())} for state in message] for message in states])
        self.train(7838, "other", "--record", "--set", "schedule.episodes=20",
                   config=ROOT / "configs/cartpole.textproto")
        both = export(self.folder / "other/traffic.lcm", channel="FRESCO_TRANSITIONS")
        self.assertEqual(both["topics"], ["FRESCO_TRANSITIONS"] * 2)
        self.assertEqual({tuple(message["message"]["state"][0]) for message in both["messages"]},
                         {tuple(states[0][0]), ("position", "velocity", "angle", "angular_velocity")})
        # A long log has several chunks; without messages there is none.
        with open(self.log, "ab") as log:
            log.write(4 * self.log.read_bytes())
        longer = export()
        self.assertGreater(longer["chunks"], 1)
        self.assertEqual(longer["statistics"], 5 * len(self.sound))
        empty = export(channel="NONE")
        self.assertEqual((empty["statistics"], empty["streamed"], empty["done"], empty["messages"]), (0, 0, True, []))
        _, errors = self.run_fresco("log", "export", self.log, "--format", "mcap", expect=2)
        self.assertIn("expected --out FILE", errors)

    def test_tables_of_all_channels_are_in_a_folder(self):
        self.record(7831)
        tables = self.folder / "tables"
        output, errors = self.run_fresco("log", "export", self.log, "--format", "csv", "--out", tables)
        self.assertIn("CAMERA", errors)
        channels = {line["channel"] for line in self.sound}
        self.assertEqual({path.name for path in tables.iterdir()}, {channel + ".csv" for channel in channels})
        one, _ = self.run_fresco("log", "export", self.log)
        self.assertEqual((tables / "FRESCO_TRANSITIONS.csv").read_text(), one)
        statuses, _ = self.run_fresco("log", "export", self.log, "--what", "learner-statuses")
        self.assertEqual((tables / "FRESCO_LEARNER_STATUS.csv").read_text(), statuses)
        count = len(one.splitlines()) - 1
        for channel in channels - {"FRESCO_TRANSITIONS"}:
            with open(tables / f"{channel}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            lines = [line["message"] for line in self.sound if line["channel"] == channel]
            self.assertEqual(len(rows), len(lines))
            self.assertEqual(list(rows[0]), list(lines[0]))
            for row, message in zip(rows, lines):
                for name, value in message.items():
                    if isinstance(value, (list, dict)):
                        self.assertEqual(json.loads(row[name]), value, name)
                    elif value is None:
                        self.assertEqual(row[name], "nan", name)
                    else:
                        self.assertEqual(type(value)(row[name]), value, name)
            count += len(rows)
        self.assertIn(f"{len(channels)} tables, {count} rows", output)
        _, errors = self.run_fresco("log", "export", self.log, "--out", tables, expect=2)
        self.assertIn("expected a new or an empty folder", errors)
        self.run_fresco("log", "export", self.log, "--out", self.folder / "one.csv")
        self.assertEqual((self.folder / "one.csv").read_text(), one)
        lines = self.folder / "lines"
        self.run_fresco("log", "export", self.log, "--format", "jsonl", "--out", lines, "--channel", "FRESCO_ORDERS")
        [table] = lines.iterdir()
        self.assertEqual([json.loads(row)["order_count"] for row in table.read_text().splitlines()],
                         [line["message"]["order_count"] for line in self.sound if line["channel"] == "FRESCO_ORDERS"])

    def test_a_channel_is_no_path(self):
        log = self.folder / "log"
        self.record(7832)
        events = list(fresco_log.EventLog(self.log))
        status = next(event for event in events if event.type == "learner_status_t")
        log.write_bytes(event_bytes(5, "../up/ÿ", status.data) + event_bytes(-5, ".hidden", status.data))
        self.run_fresco("log", "export", log, "--out", self.folder / "tables")
        self.assertEqual(sorted(path.name for path in (self.folder / "tables").iterdir()),
                         ["%2E.%2Fup%2F%C3%BF.csv", "%2Ehidden.csv"])

    def test_python_module_reads_what_cat_shows(self):
        self.record(7833)
        log = fresco_log.EventLog(self.log)
        events = list(log)
        self.assertEqual(len(events), len(self.lines))
        for event, line in zip(events, self.lines):
            self.assertEqual((event.utime, event.channel, event.type), (line["utime"], line["channel"], line["type"]))
            self.assertEqual(event.message is not None, "message" in line)
            if event.message is not None:
                wanted = line["message"]
                if event.type == "transitions_t":  # as_dict has no names
                    wanted["state"] = [list(state.values()) for state in wanted["state"]]
                    del wanted["action_name"]
                self.assert_same(fresco_log.as_dict(event.message), wanted, event.type)
        self.assertEqual(len(list(log.messages("learner_status_t", "orders_t"))),
                         sum(line["type"] in ("learner_status_t", "orders_t") for line in self.sound))
        table = list(csv.DictReader(self.run_fresco("log", "export", self.log)[0].splitlines()))
        for row, wanted in zip(log.transitions(), table, strict=True):
            self.assertEqual(list(row), list(wanted))
            for name, value in row.items():
                found = float32(float(wanted[name])) if isinstance(value, float) else type(value)(wanted[name])
                self.assertEqual(value, found, name)

    def test_python_module_reads_damaged_and_several_logs_as_cat_does(self):
        self.record(7834)
        data = self.log.read_bytes()
        middle = data.find(b"\xED\xA1\xDA\x01", len(data) // 2)
        damaged = {"torn": data[:-20], "garbage": data[:middle] + b"garbage" * 50 + data[middle:],
                   "length": data[:middle + 26] + b"\x7f" + data[middle + 27:], "empty": b"", "short": data[:20]}
        for name, content in damaged.items():
            path = self.folder / name
            path.write_bytes(content)
            log = fresco_log.EventLog(path)
            self.assertEqual([(event.utime, event.channel) for event in log],
                             [(line["utime"], line["channel"]) for line in self.cat(path)], name)
            whole = sum(HEADER.size + len(event.channel) + len(event.data) for event in log)
            self.assertEqual(log.unread_bytes, len(content) - whole, name)
        several = [self.folder / "torn", self.log]
        self.assertEqual([(event.utime, event.channel) for event in fresco_log.EventLog(*several)],
                         [(line["utime"], line["channel"]) for line in self.cat(*several)])
        with self.assertRaisesRegex(ValueError, "expected an LCM event log"):
            fresco_log.EventLog(__file__)

    def test_python_module_takes_no_damaged_message_and_one_with_a_tag(self):
        self.record(7835)
        for event in fresco_log.EventLog(self.log):
            if event.type in ("transitions_t", "learner_status_t", "run_t") and event.message is not None:
                for size in (0, 7, 8, 40, len(event.data) - 5, len(event.data) - 1):
                    self.assertIsNone(fresco_log.decode(event.data[:size]))
                tagged = fresco_log.decode(event.data + bytes(32))
                self.assertEqual(fresco_log.as_dict(tagged).keys(), fresco_log.as_dict(event.message).keys())

    def test_example_draws_a_run(self):
        self.record(7836)
        for picture, beginning in (("run.svg", b"<?xml"), ("run.png", b"\x89PNG")):
            command = [sys.executable, ROOT / "examples/plot_log/plot_log.py", self.log, self.folder / picture]
            drawn = subprocess.run(command, env=dict(os.environ, PYTHONPATH=str(MODULES)), capture_output=True,
                                   text=True)
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            self.assertIn("loss, average_aoi [slots], return", drawn.stdout)
            self.assertTrue((self.folder / picture).read_bytes().startswith(beginning))

    def test_repair_saves_every_sound_event(self):
        self.record(7837)
        data = self.log.read_bytes()
        events = [(event.utime, event.channel, event.data) for event in fresco_log.EventLog(self.log)
                  if event.type is None or event.message is not None]

        def begin(number):
            return sum(HEADER.size + len(channel) + len(message) for _, channel, message in events[:number])

        def repair(name, content):
            (self.folder / name).write_bytes(content)
            out = self.folder / (name + ".new")
            output, _ = self.run_fresco("log", "repair", self.folder / name, "--out", out)
            return output, [(event.utime, event.channel, event.data) for event in fresco_log.EventLog(out)]
        output, saved = repair("one-damaged-message", data)
        self.assertEqual(saved, events)
        self.assertIn("an event with a damaged message", output)
        sound = b"".join(event_bytes(*event) for event in events)
        output, saved = repair("sound", sound)
        self.assertEqual(saved, events)
        self.assertIn("nothing is lost", output)
        output, saved = repair("torn", sound[:-1])
        self.assertEqual(saved, events[:-1])
        torn = len(sound) - 1 - begin(len(events) - 1)
        self.assertIn(f"from byte {begin(len(events) - 1)}: {torn} bytes, the end of the log", output)
        output, saved = repair("garbage", sound[:begin(99)] + bytes(1000) + sound[begin(99):])
        self.assertEqual(saved, events)
        self.assertIn(f"lost: 1000 of {len(sound) + 1000} bytes", output)
        self.assertIn(f"from byte {begin(99)}: 1000 bytes, damaged", output)
        for number, byte in ((0, 1), (50, 3), (50, 22), (50, 27)):  # in sync word, length of the channel and message
            flipped = bytearray(sound)
            flipped[begin(number) + byte] ^= 0x10
            output, saved = repair(f"flipped-{number}-{byte}", flipped)
            self.assertEqual(saved, events[:number] + events[number + 1:], (number, byte))
            self.assertIn(f"from byte {begin(number)}: ", output)
        for wrong, word in ((["torn", "--out", "sound"], "written over"), (["none", "--out", "x"], "No such file"),
                            (["torn"], "--out")):
            _, errors = self.run_fresco("log", "repair", *wrong, expect=2, cwd=self.folder)
            self.assertIn(word, errors)
        self.assertEqual((self.folder / "sound").read_bytes(), sound)


if __name__ == "__main__":
    unittest.main()
