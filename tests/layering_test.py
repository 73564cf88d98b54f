#!/usr/bin/env python3
"""The dependency rule of docs/architecture.md: which folder may include which, and one CMake target
a folder that links exactly this. Fails naming file and line of every breach."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# In dependency order: a room may include only rooms above it, and of these only the ones listed.
ALLOWED = {
    "core": set(),
    "nn": {"core"},
    "worlds": {"core"},
    "planner": {"core", "worlds"},
    "plugins": {"core", "worlds"},
    "bus": {"core"},
    "msgs": {"core", "nn", "worlds", "plugins", "bus"},
    "training": {"core", "nn", "worlds", "msgs"},
    "storage": {"core", "nn", "worlds", "planner", "msgs", "training"},
    "exports": {"core", "nn", "worlds", "msgs", "storage"},
    "actors": {"core", "nn", "worlds", "bus", "msgs", "training"},
    "learner": {"core", "nn", "worlds", "planner", "bus", "msgs", "training", "storage"},
    "logs": {"core", "nn", "worlds", "planner", "bus", "msgs", "training", "storage"},
    "processes": {"core", "nn", "bus", "msgs", "storage", "actors", "learner"},
    "report": {"core", "nn", "worlds", "planner", "bus", "msgs", "training", "storage", "processes"},
    "paper": {"core", "worlds", "planner", "bus", "msgs", "storage", "processes", "report"},
    "soak": {"core", "bus", "msgs", "storage", "processes", "report"},
    "tools": {"core", "nn", "worlds", "planner", "bus", "msgs", "training", "storage", "exports", "actors", "learner", "logs",
              "processes", "report", "paper", "soak"},
}
# Libraries that only some rooms may see.
RESERVED = {
    "lcm/": {"bus", "logs"},
    "sodium": {"bus"},
    "Eigen/": {"nn"},
    "google/protobuf/": {"msgs", "logs"},
    "zlib.h": {"logs"},
    "png.h": {"msgs"},
    "onnx/": {"exports"},
    "curses.h": {"tools"},
    "nlohmann/": {"plugins", "storage", "logs", "processes", "report", "paper", "soak", "tools"},
}
# What may know the UAV's world: its own rooms, and its files in rooms that serve every world. The others ask a world
# for what it has (worlds/world.h) and msgs/worlds.h for messages.
UAV_ROOMS = {"worlds/uav", "planner", "paper"}
UAV_FILES = re.compile(r"(msgs/(uav_config|flight_messages|map_file|worlds)|report/flight_\w+)\.(h|cc)")
UAV_NAMES = re.compile(r"\b(AsUavWorld|RequireUavWorld|UavWorld)\b|\"uav\"")
PURE = {"nn", "worlds", "planner", "training"}  # no input or output, no clock, no random numbers but the counter-based ones
IMPURE = re.compile(r"#include <(iostream|fstream|cstdio|chrono|random|thread|filesystem|unistd\.h)>")


def breaches():
    for room, allowed in ALLOWED.items():
        for path in sorted((ROOT / room).rglob("*")):
            if path.suffix not in {".h", ".cc"}:
                continue
            name = str(path.relative_to(ROOT))
            knows_uav = name.startswith(tuple(f"{place}/" for place in UAV_ROOMS)) or UAV_FILES.fullmatch(name)
            for number, line in enumerate(path.read_text().splitlines(), 1):
                where = f"{name}:{number}"
                if not knows_uav and (line.startswith('#include "worlds/uav/') or UAV_NAMES.search(line)):
                    yield f"{where}: only the rooms and files of the UAV's world may know it"
                include = re.match(r'#include ["<]([^">]+)[">]', line)
                if not include:
                    continue
                target = include.group(1).split("/")[0]
                if target in ALLOWED and target != room and target not in allowed:
                    yield f"{where}: {room} may not include {target}"
                for prefix, rooms in RESERVED.items():
                    if include.group(1).startswith(prefix) and room not in rooms:
                        yield f"{where}: only {', '.join(sorted(rooms))} may include <{prefix}…>"
                if room in PURE and IMPURE.match(line):
                    yield f"{where}: {room} is pure: no input or output, clock or random device"
        cmake = (ROOT / room / "CMakeLists.txt").read_text()
        for linked in set(re.findall(r"fresco_(\w+)", cmake)) & set(ALLOWED):
            if linked != room and linked not in allowed:
                yield f"{room}/CMakeLists.txt: {room} may not link fresco_{linked}"


def forgotten_tests():
    """Tests that no program is built from pass for ever."""
    for path in sorted((ROOT / "tests").rglob("*_test.cc")):
        cmake = next(folder / "CMakeLists.txt" for folder in path.parents if (folder / "CMakeLists.txt").exists())
        if str(path.relative_to(cmake.parent)) not in cmake.read_text():
            yield f"{path.relative_to(ROOT)}: not in {cmake.relative_to(ROOT)}"


def main():
    found = list(breaches()) + list(forgotten_tests())
    for breach in found:
        print(breach)
    files = sum(1 for room in ALLOWED for _ in (ROOT / room).rglob("*.cc"))
    print(f"{files} source files in {len(ALLOWED)} rooms, {len(found)} breaches")
    return 1 if found or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
