"""`fresco spy`: lcm-spy decodes every message of a run, with a key and without, and Fresco's windows draw it."""
import os
import signal
import sys
import unittest

import spy_display
from fresco_process import CI_CONFIG, ROOT, FrescoTest, url, wait_until

TYPES = {"RUN": "run_t", "ORDERS": "orders_t", "TRANSITIONS": "transitions_t", "WEIGHTS_CURRENT": "weights_t",
         "WEIGHTS_TARGET": "weights_t", "ACTOR_STATUS": "actor_status_t", "LEARNER_STATUS": "learner_status_t",
         "SCENARIO": "scenario_t", "FLIGHT": "flight_t", "WORLD": "world_t"}
# A small training in another world: no scenario, no flights, no optimum.
CARTPOLE = ["--config", ROOT / "configs" / "cartpole.textproto", "--set", "cartpole.maximum_steps=200",
            "--set", "agent.hidden_layers=16", "--set", "schedule.evaluation_episodes=5"]
MANY_COLOURS = 100  # a window that draws has hundreds, one that is blank a few


@unittest.skipIf(spy_display.what_is_missing(), f"needs {spy_display.what_is_missing()}")
class SpyOnARun(FrescoTest):
    def setUp(self):
        super().setUp()
        self.display = self.enterContext(spy_display.Display())

    def spy(self, port, *arguments):
        return self.enterContext(spy_display.Spy(self.display, port, *arguments))

    def start_training(self, port, *arguments):
        """A run without an end."""
        process = self.start("train", "--lcm-url", url(port), "--out", self.folder / "run", "--format", "json",
                             "--set", "schedule.episodes=1000000", *arguments)
        self.addCleanup(self.stop, process)

    def start_run(self, port, *arguments):
        """A run without an end in the UAV's world, and a flight beside it."""
        self.start_training(port, "--config", CI_CONFIG, *arguments)
        fly = self.start("fly", "--config", CI_CONFIG, "--policy", "aoi", "--rate", 20, "--loop", "--lcm-url",
                         url(port), *arguments)
        self.addCleanup(self.stop, fly)

    @staticmethod
    def stop(process):
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=30)

    def check_all_is_decoded(self, spy):
        wait_until(lambda: spy.hears(*TYPES), "every channel in lcm-spy's table", 90)
        wait_until(lambda: min(channel.received for channel in spy.ours().values()) > 20, "twenty messages of each",
                   90)
        self.assertEqual({name: channel.type for name, channel in spy.ours().items()},
                         {"FRESCO_" + name: type for name, type in TYPES.items()})
        for name, channel in spy.ours().items():
            self.assertEqual(channel.undecodable, 0, name)

    def test_decodes_every_message_of_every_channel(self):
        spy = self.spy(7855)
        self.start_run(7855)
        self.check_all_is_decoded(spy)

    def test_decodes_every_message_of_a_run_with_a_key(self):
        spy = self.spy(7856)
        self.start_run(7856, "--key-file", self.key())
        self.check_all_is_decoded(spy)

    def test_draws_its_windows(self):
        self.start_run(7857)
        for name in ("flight", "learner", "actors", "episode"):
            self.check_is_drawn(7857, name, name)

    def check_is_drawn(self, port, option, name):
        with spy_display.Spy(self.display, port, "--open", option):
            window = self.display.window(name)
            wait_until(lambda: self.display.colours(window) > MANY_COLOURS, f"the window {name} to be drawn")

    def test_draws_a_run_in_another_world(self):
        self.start_training(7859, *CARTPOLE)
        for name in ("learner", "actors", "episode"):
            self.check_is_drawn(7859, name, name)

    def test_opens_the_window_that_fits_the_world(self):
        spy = self.spy(7860, "--open", "all")
        self.start_training(7860, *CARTPOLE)
        for name in ("learner", "actors", "episode"):
            self.display.window(name)
        wait_until(lambda: spy.hears("WORLD", "TRANSITIONS", "LEARNER_STATUS"), "the run in lcm-spy's table")
        self.assertEqual([name for name, channel in spy.ours().items() if channel.undecodable], [])
        self.assertFalse(self.display.shows("flight"))

    def test_opens_it_by_a_double_click(self):
        spy = self.spy(7861)
        self.start_training(7861, *CARTPOLE)
        wait_until(lambda: spy.hears(*(set(TYPES) - {"SCENARIO", "FLIGHT"})), "all of the run in lcm-spy's table")
        self.double_click(spy, "TRANSITIONS")
        self.display.window("episode")

    def double_click(self, spy, name):
        """The table sorts channels by name, under a title."""
        row = sorted(spy.channels).index("FRESCO_" + name)
        self.display.double_click(self.display.window("table"), 60, 30 + 16 * row)


class SpyWithoutADisplay(FrescoTest):
    def test_says_what_is_missing(self):
        environment = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
        _, errors = self.run_fresco("spy", expect=2, env=environment)
        self.assertIn("DISPLAY", errors)
        self.assertIn("xvfb-run", errors)

    def test_refuses_wrong_use(self):
        for arguments, word in [(["--open", "door"], "door"), (["--channel-prefix", "A.*"], "A.*"),
                                (["--lcm-url", "nowhere"], "nowhere")]:
            _, errors = self.run_fresco("spy", *arguments, expect=2, env=dict(os.environ, DISPLAY=":9999"))
            self.assertIn(word, errors)


if __name__ == "__main__":
    sys.exit(unittest.main())
