"""Makes the pictures of docs/lcm.md: FRESCO_BIN=build/release/bin python3 tests/integration/spy_pictures.py"""
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import spy_display
from fresco_process import BIN, ROOT, url

PORT = 7858
PICTURES = ROOT / "docs" / "images"
EPISODES = 2500


def main():
    missing = spy_display.what_is_missing()
    if missing:
        sys.exit(f"spy_pictures: needs {missing}")
    PICTURES.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="fresco-pictures-") as folder, spy_display.Display() as display:
        picture_flight(display)
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
        time.sleep(11)  # slot 56 of 70: most of the flight is to be seen
        take(display, "flight")
        end(fly)


def picture_run(display, folder):
    with spy_display.Spy(display, PORT, "--open", "learner"):
        display.window("table")
        run = start("train", "--out", folder / "run", "--set", f"schedule.episodes={EPISODES}")
        display.window("learner")
        time.sleep(45)
        take(display, "learner")
    for name in ("actors", "table"):
        with spy_display.Spy(display, PORT, *(["--open", name] if name == "actors" else [])):
            display.window(name)
            time.sleep(20)
            take(display, name)
    end(run)


def start(*arguments):
    return subprocess.Popen([BIN / "fresco", *map(str, arguments), "--lcm-url", url(PORT)],
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def end(process):
    process.send_signal(signal.SIGINT)
    process.wait(60)


if __name__ == "__main__":
    main()
