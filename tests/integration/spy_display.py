"""A display that nobody sees, and lcm-spy on it: for the test of `fresco spy` and for the pictures of the docs."""
import collections
import os
import shutil
import subprocess
import threading
import time

from fresco_process import BIN, url

NEEDED = ("java", "Xvfb", "xdotool", "import", "convert")
JAR = BIN.parent / "share" / "fresco" / "fresco_spy.jar"
TITLES = {"flight": "Fresco flight: ", "learner": "Fresco learner: run", "actors": "Fresco actors: run", "episode": "Fresco episode: ",
          "table": "LCM Spy"}
WIDTH, HEIGHT = 1280, 840

Channel = collections.namedtuple("Channel", "type received undecodable")


def what_is_missing():
    """The first thing that `fresco spy` on a display of its own would need and does not find; empty: nothing."""
    missing = [name for name in NEEDED if shutil.which(name) is None]
    if missing:
        return f"the program {missing[0]}"
    return "" if JAR.exists() else f"{JAR} (target spy)"


class Display:
    """An X server without a screen; `number` is the lowest that was free."""

    def __enter__(self):
        reading, writing = os.pipe()
        self._server = subprocess.Popen(
            # Without -noreset, the server starts anew when its last client leaves, and hangs one that comes just then.
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-nolisten", "tcp",
             "-noreset"],
            pass_fds=[writing], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            self.environment = dict(os.environ, DISPLAY=":" + number.readline().strip())
        return self

    def __exit__(self, *_):
        self._server.terminate()
        self._server.wait(10)

    def run(self, *command, timeout_s=30):
        return subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=timeout_s)

    def window(self, name, timeout_s=60):
        """The id of lcm-spy's table or of one of Fresco's windows once it shows something."""
        deadline = time.monotonic() + timeout_s
        while time.monotonic() < deadline:
            found = self.run("xdotool", "search", "--onlyvisible", "--name", TITLES[name]).stdout.split()
            if found:
                return found[-1]
            time.sleep(0.1)
        raise AssertionError(f"waited {timeout_s} s for the window \"{TITLES[name]}\"")

    def shows(self, name):
        return bool(self.run("xdotool", "search", "--onlyvisible", "--name", TITLES[name]).stdout.split())

    def double_click(self, window, x, y):
        self.run("xdotool", "mousemove", "--window", window, str(x), str(y))
        self.run("xdotool", "click", "--repeat", "2", "--delay", "60", "1")

    def picture(self, window, path):
        """Its content as a PNG, as small as can be without a loss that is seen."""
        self.run("import", "-window", window, str(path))
        self.run("convert", str(path), "-strip", "-colors", "256", "PNG8:" + str(path))

    def colours(self, window):
        text = self.run("import", "-window", window, "-format", "%k", "info:-").stdout
        return int(text) if text.strip().isdigit() else 0


class Spy:
    """`fresco spy --print-table` on a display; `channels` is its table as it was printed last."""

    def __init__(self, display, port, *arguments):
        self.channels = {}
        self._process = subprocess.Popen(
            [BIN / "fresco", "spy", "--lcm-url", url(port), "--print-table", *arguments], env=display.environment,
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait(60)  # Java may be starting, on a busy machine
        self._reader.join(10)
        self._process.stdout.close()

    def _read(self):
        for line in self._process.stdout:
            words = line.split()
            if len(words) == 4 and words[3].isdigit():
                self.channels[words[0]] = Channel(words[1], int(words[2]), int(words[3]))

    def ours(self):
        """LCM's own channel is none of Fresco's: with it LCM tries whether multicast comes back."""
        return {name: channel for name, channel in list(self.channels.items()) if name != "LCM_SELF_TEST"}

    def hears(self, *names):
        return {"FRESCO_" + name for name in names} <= set(self.channels)
