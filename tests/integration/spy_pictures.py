"""Makes the pictures of docs/lcm.md: FRESCO_BIN=build/release/bin python3 tests/integration/spy_pictures.py"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import spy_display
from fresco_process import BIN, ROOT, url, wait_until

PORT = 7858
PICTURES = ROOT / "docs" / "images"


def main():
    missing = spy_display.what_is_missing()
    if missing:
        sys.exit(f"spy_pictures: needs {missing}")
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="fresco-pictures-") as folder, spy_display.Display() as display:
        picture_flight(display)
        picture_episode(display, pathlib.Path(folder))
        picture_run(display, pathlib.Path(folder))


def take(display, name):
    path = PICTURES / f"spy_{name}.png"
    display.picture(display.window(name), path)
    print(f"{path.relative_to(ROOT)}: {path.stat().st_size} bytes")


def picture_flight(display):
    with spy_display.Spy(display, PORT, "--open", "flight"):
        display.window("table")
        time.sleep(2)  # for the window behind which nothing is heard yet
        fly = start("fly", "--policy", "optimal", "--rate", 5)
        display.window("flight")
        time.sleep(8)  # about slot 41 of 70: the flight is to be seen, and data are collected
        take(display, "flight")
        end(fly)


def picture_episode(display, folder):
    run = start("train", "--config", ROOT / "configs" / "cartpole.textproto", "--set", "schedule.episodes=100000",
                "--out", folder / "cartpole")
    time.sleep(15)  # until the pole is balanced for long
    with spy_display.Spy(display, PORT, "--open", "episode"):
        display.window("episode")
        time.sleep(5)
        take(display, "episode")
    end(run)


def picture_run(display, folder):
    log = folder / "log"
    with spy_display.Spy(display, PORT, "--open", "learner"):
        display.window("table")
        run = start("train", "--out", folder / "run", log=log)
        wait_until(lambda: re.search(r"\(\d+\.\d+ % over the optimum", log.read_text()), "the gap to the optimum", 300)
        time.sleep(10)
        take(display, "learner")
    for name, seconds in (("actors", 20), ("table", 8)):
        with spy_display.Spy(display, PORT, *(["--open", name] if name == "actors" else [])):
            display.window(name)
            time.sleep(seconds)
            take(display, name)
    end(run)


def start(*arguments, log=os.devnull):
    with open(log, "w", encoding="utf-8") as errors:
        return subprocess.Popen([BIN / "fresco", *map(str, arguments), "--lcm-url", url(PORT)],
                                stdout=subprocess.DEVNULL, stderr=errors)


def end(process):
    process.send_signal(signal.SIGINT)
    process.wait(60)


if __name__ == "__main__":
    main()
