"""Starts Fresco's programs for the integration tests: each test on an LCM port of its own."""
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ["FRESCO_BIN"])
# Programs with a sanitizer are slow and need more memory: another configuration then, deadlines so many times longer,
# and further arguments for every soak.
CI_CONFIG = pathlib.Path(os.environ.get("FRESCO_CI_CONFIG", ROOT / "configs" / "ci.textproto"))
PATIENCE = float(os.environ.get("FRESCO_PATIENCE", 1))
SOAK_ARGUMENTS = os.environ.get("FRESCO_SOAK_ARGUMENTS", "").split()


# As errors and help list them.
READY_EXPERIMENTS = ", ".join(sorted(path.stem for path in (ROOT / "configs").glob("*.textproto")))


def url(port):
    return f"udpm://239.255.76.67:{port}?ttl=0"


def processes_with(argument):
    """Process ids whose command line has the argument: nothing may be left behind."""
    found = []
    for entry in pathlib.Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                if argument.encode() in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                pass
    return [pid for pid in found if pid != os.getpid()]


def actors_on(port):
    return sorted(set(processes_with("fresco-actor")) & set(processes_with(url(port))))


def wait_until(condition, what, timeout_s=60):
    timeout_s *= PATIENCE
    deadline = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError(f"waited {timeout_s} s for {what}")
        time.sleep(0.01)


class Process(subprocess.Popen):
    def communicate(self, input=None, timeout=None):
        return super().communicate(input, timeout and timeout * PATIENCE)


class FrescoTest(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="fresco-test-")
        self.folder = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def start(self, *arguments, program="fresco", **options):
        return self.start_command([BIN / program, *map(str, arguments)], **options)

    def start_command(self, command, **options):
        """A process that does not outlive a test that fails."""
        streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        process = Process(command, text=True, **(streams | options))

        def end():
            if process.returncode is None:
                process.kill()
                process.communicate()
        self.addCleanup(end)
        return process

    def run_fresco(self, *arguments, expect=0, program="fresco", **options):
        process = self.start(*arguments, program=program, **options)
        output, errors = process.communicate(timeout=240)
        self.assertEqual(process.returncode, expect, f"{arguments}\n{output}\n{errors}")
        return output, errors

    def train(self, port, name, *arguments, config=CI_CONFIG, expect=0):
        output, _ = self.run_fresco("train", "--config", config, "--lcm-url", url(port), "--out",
                                    self.folder / name, "--format", "json", *arguments, expect=expect)
        return json.loads(output)

    def summary_of(self, process):
        output, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, errors)
        return json.loads(output)

    def key(self, name="key", content=None, mode=0o600):
        path = self.folder / name
        path.write_bytes(os.urandom(32) if content is None else content)
        path.chmod(mode)
        return path

    def learner_of(self, name):
        """Process id of the learner that works in the folder; None: there is none."""
        found = set(processes_with("fresco-learner")) & set(processes_with(str(self.folder / name)))
        return min(found) if found else None

    def run_id(self, name):
        arguments = pathlib.Path(f"/proc/{self.learner_of(name)}/cmdline").read_text().split("\0")
        return int(arguments[arguments.index("--run-id") + 1], 16)

    def evaluations(self, name):
        path = self.folder / name / "metrics.csv"
        return max(0, len(path.read_text().splitlines()) - 1) if path.exists() else 0

    def wait_for_evaluation(self, name):
        wait_until(lambda: self.evaluations(name) > 0, "a first evaluation")


def read_log(path):
    """Events of an LCM log: (channel, data). The format stands in LCM's documentation."""
    data = pathlib.Path(path).read_bytes()
    position = 0
    while position + 28 <= len(data):
        sync, _, _, channel_size, size = struct.unpack_from(">IqqII", data, position)
        if sync != 0xEDA1DA01:
            raise ValueError(f"no event at byte {position}")
        begin = position + 28
        if begin + channel_size + size > len(data):
            return
        yield data[begin:begin + channel_size].decode(), data[begin + channel_size:begin + channel_size + size]
        position = begin + channel_size + size
