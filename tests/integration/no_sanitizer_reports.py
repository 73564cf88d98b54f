"""Fails where a process left a sanitizer's report in the folder given, and prints every one of them."""
import pathlib
import sys


def main():
    reports = sorted(path for path in pathlib.Path(sys.argv[1]).rglob("*") if path.is_file() and path.stat().st_size)
    for path in reports:
        print(f"---- {path}\n{path.read_text(errors='replace')}")
    print(f"{len(reports)} reports of sanitizers in {sys.argv[1]}: TEST.PROGRAM.PROCESS")
    return 1 if reports else 0


if __name__ == "__main__":
    sys.exit(main())
