#!/usr/bin/env python3
"""Draws a run from its log: loss, score of the greedy evaluations, and return of each episode, over time.

    plot_log.py traffic.lcm [traffic-2.lcm ...] run.svg         # or run.png

It needs the Debian package gnuplot-nox, and the Python module fresco_log, which is part of the package fresco. Without
that package: PYTHONPATH=build/release/lib/python3/dist-packages
"""
import collections
import math
import subprocess
import sys

import fresco_log


def curves(log):
    """(title of the axis, points) of each chart; a point is (seconds, value)."""
    losses, scores = [], []
    rewards = collections.defaultdict(dict)  # of each episode: the sum of each of its messages
    ends = {}
    titles = {run_id: "{0[0]} [{0[1]}]".format(names.figures[0]) for run_id, names in log.world_names().items()}
    begin, title = None, "score"
    for event in log:
        if event.type not in ("learner_status_t", "transitions_t") or (message := event.message) is None:
            continue
        begin = event.utime if begin is None else begin
        seconds = 1e-6 * (event.utime - begin)
        if event.type == "learner_status_t":
            title = titles.get(message.run_id, title)
            losses.append((seconds, message.loss))
            if not math.isnan(message.score):
                scores.append((seconds, message.score))
        else:  # a part of a long state has the rewards, too, and an episode may be sent twice
            episode = message.run_id, message.order_index
            rewards[episode][message.first_transition] = sum(message.reward)
            ends.setdefault(episode, seconds)
    returns = sorted((ends[episode], sum(parts.values())) for episode, parts in rewards.items())
    return [("loss", losses), (title, scores), ("return", returns)]


def gnuplot_script(charts, picture):
    terminal = "pngcairo" if picture.endswith(".png") else "svg"
    picture = picture.replace("'", "''")
    end_s = max(seconds for _, points in charts for seconds, _ in points)
    lines = [f"set terminal {terminal} size 900,900", f"set output '{picture}'", "set key off", "set grid",
             f"set multiplot layout {len(charts)},1", "set xlabel 'seconds'", f"set xrange [0:{end_s or 1}]"]
    for number, (title, points) in enumerate(charts):
        style = "points pointtype 7 pointsize 0.3" if title == "return" else "lines"
        lines += [f"$chart{number} << end", *(f"{x} {y}" for x, y in points), "end", f'set ylabel "{title}" noenhanced',
                  f"plot $chart{number} using 1:2 with {style}"]
    return "\n".join([*lines, "unset multiplot", ""])


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    *logs, picture = sys.argv[1:]
    charts = [(title, points) for title, points in curves(fresco_log.EventLog(*logs)) if points]
    if not charts:
        sys.exit(f"plot_log.py: {', '.join(logs)}: expected a run's statuses and transitions; found none")
    subprocess.run(["gnuplot"], input=gnuplot_script(charts, picture), text=True, check=True)
    print(f"{picture}: {', '.join(title for title, _ in charts)}")


if __name__ == "__main__":
    main()
