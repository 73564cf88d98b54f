"""Wrong use ends with exit status 2 and a word on what is wrong, where, and what is allowed; it leaves nothing behind."""
import os
import shutil
import signal
import sys
import unittest

from fresco_process import BIN, CI_CONFIG, READY_EXPERIMENTS, FrescoTest, url, wait_until

CONFIGS = [
    ("scenario { slotz: 70 }", ["slotz", "did you mean slots?"]),
    ("scenario { slots: 0 }", ["scenario.slots", "0", "allowed"]),
    ("agent { batch_size: 0 }", ["agent.batch_size", "0", "allowed"]),
    ("agent { discount: nan }", ["agent.discount", "nan", "allowed"]),
    ("scenario { sensor { x_m: 1 y_m: 1 } random_sensors { count: 2 } }", ["sensor", "random_sensors"]),
    ("scenario { slots: 10 }", ["slots", "10"]),
    ("scenario { initial_energy_j: 100 }", ["initial_energy_j", "100"]),
    ("scenario { coverage_radius_m: 100 transmit_power_w: 1 }", ["coverage_radius_m", "transmit_power_w"]),
    ("scenario { transmit_power_w: 1e-9 }", ["1e-09"]),
    ("run { channel_prefix: \"a b\" }", ["run.channel_prefix", "a b", "allowed"]),
    ("scenario {}\ncartpole {}", ["textproto:2:", "cartpole", "scenario"]),
    ("cartpole { maximum_steps: 0 }", ["cartpole.maximum_steps", "0", "allowed"]),
    ("cartpole {} agent { coverage_mask: true }", ["agent.coverage_mask", "true", "allowed", "cartpole"]),
    ("acrobot {} schedule { excursion_share: 0.5 }", ["schedule.excursion_share", "0.5", "allowed", "acrobot"]),
    ("scenario { random_field { any_stop: true } }", ["scenario.random_field", "per_episode: true"]),
]
# What every program refuses that is on a bus.
URLS = [
    (["--lcm-url", "udp://1"], ["udp", "udpm://"]),
    (["--lcm-url", "udpm//239.255.76.67:7667"], ["udpm"]),
    (["--lcm-url", "udpm://10.0.0.1:7667"], ["10.0.0.1"]),
    (["--lcm-url", "udpm://239.255.76.67:7667?tll=0"], ["tll"]),
    (["--lcm-url", "tcpq://127.0.0.1:17340"], ["tcpq", "TCPService"]),
]
BUS = URLS + [
    (["--key-file", "no-key"], ["--key-file: no-key", "No such file"]),
    (["--disturb", "drop=2"], ["drop"]),
]
# What every program refuses that reads an experiment.
EXPERIMENTS = [
    (["--config", "/nowhere.textproto"], ["/nowhere.textproto", READY_EXPERIMENTS]),
    (["--config", "quik"], ["did you mean quick?"]),
    (["--config", "configs/papr.textproto"], ["did you mean paper?"]),
    (["--set", "agent.batchsize=3"], ["batchsize", "did you mean agent.batch_size?"]),
    (["--set", "agnet.hidden_layers=3"], ["did you mean agent.hidden_layers?"]),
    (["--set", "agent.batch_size=many"], ["many"]),
    (["--set", "agent"], ["path=value"]),
    (["--set", "cartpole.maximum_steps=9"], ["cartpole.maximum_steps", "scenario", "--config"]),
]
NO_FOLDER = (["--out", "file/run"], ["--out", "file is not a folder"])
NO_PROGRAMS = {"PATH": "/nowhere"}


# Fields whose size no host has the memory for, and what they are for.
TOO_LARGE = [
    (["agent.replay_capacity=100000000", "scenario.random_sensors.count=250", "agent.sensor_geometry=true"],
     # 10,984 bytes a transition: 6,200 as the network sees it, and four times the 1,196 of its episode, since a checkpoint
     # takes three copies.
     ["agent.replay_capacity: the replay memory needs 741.0 GB"]),
    (["run.optimum_memory_mb=1000000"], ["run.optimum_memory_mb: the search for the exact optimum needs 1000.0 GB"]),
    (["schedule.window=4096", "schedule.updates_per_version=1", "schedule.inserts_per_update=1",
      "agent.hidden_layers=2000,2000"], ["schedule.window: the versions of the networks"]),
    (["agent.hidden_layers=2000,2000", "run.actors=1024"], ["agent.hidden_layers: the networks that it holds"]),
]


class BadInput(FrescoTest):
    """Every program is started in a folder of its own, in which nothing may appear or change."""

    def setUp(self):
        super().setUp()
        self.here = self.folder / "here"
        self.here.mkdir()
        (self.here / "file").write_text("not a folder")

    def content(self):
        return {path: path.read_bytes() if path.is_file() else None for path in self.here.rglob("*")}

    def refuse(self, words, *arguments, program="fresco", **options):
        with self.subTest(program=program, arguments=arguments):
            before = self.content()
            output, errors = self.run_fresco(*arguments, program=program, expect=2, cwd=self.here, **options)
            for word in words:
                self.assertIn(word, errors)
            self.assertEqual(output, "")
            self.assertEqual(self.content(), before)

    def refuse_all(self, cases, *command, **options):
        for arguments, words in cases:
            self.refuse(words, *command, *arguments, **options)

    def test_in_a_configuration_is_named_with_file_field_value_and_what_is_allowed(self):
        for number, (text, words) in enumerate(CONFIGS):
            path = self.folder / f"bad-{number}.textproto"
            path.write_text(text)
            self.refuse(words + [path.name], "train", "--config", path)

    def test_of_train_leaves_nothing_behind(self):
        self.refuse_all(BUS + EXPERIMENTS + [
            NO_FOLDER, (["--actors", "-1"], ["--actors"]), (["--frobnicate"], ["frobnicate"]),
            (["--resume", "no-run"], ["no-run"]), (["--set", "run.lcm_url=udp://1"], ["udp"])], "train")

    def test_of_evaluate_and_fly_leaves_nothing_behind(self):
        for command in ("evaluate", "fly"):
            self.refuse_all(EXPERIMENTS, command, "--policy", "aoi")
        # Nobody waits for the optimum of a large field to hear that the URL is wrong.
        self.refuse_all(BUS, "fly", "--policy", "optimal", "--config", "quick", "--set", "scenario.slots=200", "--set",
                        "scenario.coverage_radius_m=150", "--set", "scenario.initial_energy_j=50000")

    def test_of_figures_and_soak_leaves_nothing_behind(self):
        self.refuse_all(BUS + EXPERIMENTS, "figures", "--quick", "--out", "study")
        self.refuse_all([NO_FOLDER], "figures", "--quick")
        self.refuse(["gnuplot", "gnuplot-nox"], "figures", "--quick", "--out", "study", env=NO_PROGRAMS)
        self.refuse_all(BUS[:-1] + EXPERIMENTS + [NO_FOLDER], "soak")

    def test_of_learner_and_actor_leaves_nothing_behind(self):
        self.refuse_all(BUS + EXPERIMENTS + [(["--run-id", "x"], ["--run-id"]), (["--confg", "a"], ["mean --config?"])],
                        "--out", "run", program="fresco-learner")
        self.refuse_all([NO_FOLDER, ([], ["--out"])], program="fresco-learner")
        self.refuse_all(BUS + [(["--run-id", "x"], ["--run-id"]), (["--channel-prefix", "a b"], ["a b"]),
                               (["--lcm-ulr", "a"], ["did you mean --lcm-url?"])], program="fresco-actor")

    def test_of_log_and_spy_leaves_nothing_behind(self):
        log = self.here / "empty.lcm"
        log.write_bytes(b"")
        self.refuse_all(URLS + [(["--channel", "("], ["--channel"])], "log", "record", "--out", "new.lcm")
        self.refuse_all([(["--out", "file"], ["written over"]), (["--out", "file/log"], ["file/log"])], "log", "record",
                        "--lcm-url", url(17344))
        for command, out in (("cut", "new.lcm"), ("export", "file")):  # a table may be written over, by a table
            self.refuse(["none.lcm"], "log", command, "none.lcm", "--out", out)
            self.refuse(["an LCM event log"], "log", command, "file", "--out", out)
            self.refuse(["udp://1"], "log", command, "udp://1", "--out", out)
            self.refuse(["--stop"], "log", command, log, "--start", 2, "--stop", 1, "--out", out)
        self.refuse(["written over"], "log", "cut", log, "--out", "file")
        self.refuse(["file/table"], "log", "export", log, "--out", "file/table")
        self.refuse(["file/table.csv"], "log", "export", log, "--out", "file/table.csv")
        self.refuse(["expected --out FILE"], "log", "export", log, "--format", "mcap")
        self.refuse(["file/a.mcap"], "log", "export", log, "--format", "mcap", "--out", "file/a.mcap")
        self.refuse_all([(["none.lcm"], ["none.lcm"]), (["file"], ["at least one whole event"]),
                         ([log], ["at least one whole event"])], "log", "repair", "--out", "new.lcm")
        self.refuse_all(URLS, "log", "play", log)
        self.refuse(["none.lcm"], "log", "play", "none.lcm")
        self.refuse_all(URLS, "spy")
        self.refuse(["java", "default-jre"], "spy", env=NO_PROGRAMS | {"DISPLAY": ":9999"})

    def test_of_a_run_that_is_gone_on_with_or_recorded_leaves_it_as_it_was(self):
        process = self.start("train", "--config", CI_CONFIG, "--lcm-url", url(17341), "--out", "runs/run", "--record",
                             "--set", "schedule.episodes=1000000", *("--set", "run.checkpoint_interval_s=0.1"), cwd=self.here)
        checkpoints = self.here / "runs" / "run" / "checkpoints"
        wait_until(lambda: len(list(checkpoints.glob("*.checkpoint"))) > 1, "two checkpoints")
        wait_until((self.here / "runs" / "run" / "best.network").exists, "an evaluation")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        latest = max(checkpoints.glob("*.checkpoint"))
        latest.write_bytes(latest.read_bytes()[:1000])  # would be set aside
        self.refuse_all(BUS + [(["--set", "schedule.seed=7"], ["only fields of run"])], "train", "--resume", "runs/run")
        self.refuse_all(BUS, "--resume", "runs/run", program="fresco-learner")
        self.refuse(["runs/run", "another run's results"], "train", "--config", CI_CONFIG, "--out", "runs/run")
        log = "runs/run/traffic.lcm"
        self.refuse_all(EXPERIMENTS + [NO_FOLDER, (["--key-file", "no-key"], ["no-key"]),
                                       (["--set", "schedule.episodes=1000000000"], ["schedule.episodes"])], "retrain", log)
        for arguments in (["train", "--resume", "runs"], ["evaluate", "--policy", "runs"]):
            self.refuse(["the newest run in it is runs/run"], *arguments)

    def test_is_named_before_anything_is_done_where_programs_are_missing(self):
        shutil.copy(BIN / "fresco", self.folder)
        alone = self.folder / "fresco"
        for arguments in (["train"], ["soak"], ["figures", "--out", "study"]):
            self.refuse(["fresco-learner", "beside"], *arguments, "--config", CI_CONFIG, program=alone)
        self.refuse(["none in"], "train", "--config", "quick", program=alone)

    @unittest.skipIf(os.geteuid() != 0, "only root may take its network away")
    def test_is_named_before_anything_is_done_where_no_route_covers_multicast(self):
        for arguments in (["train"], ["figures", "--out", "study"], ["soak"], ["log", "record", "--out", "new.lcm"],
                          ["fly", "--policy", "aoi"], ["spy"]):
            process = self.start_command(["unshare", "--net", BIN / "fresco", *arguments], cwd=self.here)
            output, errors = process.communicate(timeout=60)
            self.assertEqual((process.returncode, output), (2, ""), errors)
            self.assertIn("ip route add", errors)
            self.assertEqual([path.name for path in self.here.iterdir()], ["file"])

    def test_of_a_name_says_the_nearest(self):
        self.refuse(["there is no command \"trian\"", "did you mean train?"], "trian")
        self.refuse(["fresco log: there is no command \"recrod\"", "did you mean record?"], "log", "recrod", "--out", "a")
        self.refuse(["did you mean log record?"], "record")
        self.refuse(["there is no option --confg; did you mean --config?"], "train", "--confg", "a")
        self.refuse(["there is no option --polciy; did you mean --policy?"], "evaluate", "--polciy", "aoi")
        for command in (["train"], ["evaluate", "--policy", "aoi"], ["retrain", "a"], ["soak"], ["log", "info", "a"]):
            self.refuse(["expected text or json, found \"jsn\"", "did you mean json?"], *command, "--format", "jsn")
        self.refuse(["did you mean csv?"], "log", "export", "a", "--format", "cvs")

    def test_of_a_policy_says_what_a_policy_can_be(self):
        kinds = "the folder of a run (with a best.network), a network file or a checkpoint"
        (self.here / "runs").mkdir()
        for policy, words in [("optimall", ["did you mean optimal?"]), ("nowhere", ["\"nowhere\""]),
                              ("runs", ["runs has no best.network"]), ("file", ["file: not a network file"])]:
            self.refuse([kinds, *words], "evaluate", "--policy", policy)
            self.refuse([kinds, *words], "fly", "--policy", policy)

    def test_of_a_world_that_can_not_do_this_is_refused_with_words(self):
        config = self.folder / "cartpole.textproto"
        config.write_text("cartpole {}")
        for policy in ("aoi", "distance", "optimal"):
            for command in ("evaluate", "fly"):
                self.refuse([f"\"{policy}\"", "the world has no policies of its own"], command, "--policy", policy, "--config", config)
        self.refuse(["fresco figures", "cartpole"], "figures", "--quick", "--config", config, "--out", "study")
        self.refuse(["scenario.slots", "cartpole"], "train", "--config", config, "--set", "scenario.slots=30")

    def test_of_a_size_that_no_memory_has_is_refused_before_anything_is_written_or_started(self):
        for settings, words in TOO_LARGE:
            config = self.folder / "field.textproto"
            config.write_text("")
            arguments = [part for setting in settings for part in ("--set", setting)]
            words = words + ["GB of memory are needed and", "are available (", "Lower "]
            self.refuse(words, "train", "--config", config, *arguments)
            self.assertFalse((self.folder / "out").exists())
            if "run.actors=1024" not in settings:  # the learner by itself takes no actors with it
                output, errors = self.run_fresco("--config", config, "--out", self.folder / "out", *arguments,
                                                 program="fresco-learner", expect=2)
                self.assertIn(words[0], errors + output)
                self.assertFalse((self.folder / "out").exists())

    def test_never_overwrites_another_runs_results(self):
        (self.here / "out").mkdir()
        (self.here / "out" / "summary.json").write_text("{}")
        for program, arguments in (("fresco", ["train"]), ("fresco-learner", [])):
            self.refuse(["new folder"], *arguments, "--config", CI_CONFIG, "--out", "out", program=program)


if __name__ == "__main__":
    sys.exit(unittest.main())
