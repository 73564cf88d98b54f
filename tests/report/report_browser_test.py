"""The report page as its reader has it: opened from disk in Chromium, headless, and used."""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BIN = pathlib.Path(os.environ["FRESCO_BIN"])

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.support.ui import Select, WebDriverWait
except ImportError as missing:
    sys.exit(f"{missing}; install Debian's package python3-selenium")

PLOT = """set terminal svg size 720,440
set title 'a'
plot x with points pointtype 7, x*x with points pointtype 5
"""
WAIT_S = 60  # until the test gives up; nothing is that slow


def program(name, package):
    path = shutil.which(name)
    if path is None:
        sys.exit(f"there is no {name} on this machine; install Debian's package {package}")
    return path


def read_flights(path):
    """What write_report_pages says of the flights: {name: [slot, ...]}."""
    flights = {}
    with open(path, newline="") as lines:
        for name, slot, column, row, move, scheduled, collected, *aoi in csv.reader(lines):
            flights.setdefault(name, []).append(
                {"slot": int(slot), "column": int(column), "row": int(row), "move": move,
                 "scheduled": int(scheduled), "collected": collected == "1",
                 "aoi": [int(age) for age in aoi]})
    return flights


class ReportPage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="fresco-report-")
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        figure = cls.folder / "figure.svg"
        figure.write_bytes(subprocess.run([program("gnuplot", "gnuplot-nox")], input=PLOT.encode(),
                                          stdout=subprocess.PIPE, check=True).stdout)
        subprocess.run([BIN / "write_report_pages", cls.folder, ROOT / "configs" / "ci.textproto", figure],
                       check=True)
        cls.flights = read_flights(cls.folder / "run.csv")
        options = webdriver.ChromeOptions()
        options.binary_location = program("chromium", "chromium")
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic",
                         "--no-first-run", "--disable-background-networking", "--disable-component-update",
                         "--disable-sync",
                         "--disable-dev-shm-usage", f"--user-data-dir={cls.folder / 'profile'}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        driver = Service(program("chromedriver", "chromium-driver"))
        cls.browser = webdriver.Chrome(service=driver, options=options)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        self.display(1280)

    def tearDown(self):
        severe = [entry for entry in self.browser.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(severe, [])

    # What a reader does

    def display(self, width, scheme="light"):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def open(self, name):
        self.browser.get((self.folder / name).as_uri())

    def by_id(self, name):
        return self.browser.find_element(By.ID, name)

    def text(self, name):
        return self.by_id(name).text

    def script(self, code, *arguments):
        return self.browser.execute_script(code, *arguments)

    def wait(self, condition):
        return WebDriverWait(self.browser, WAIT_S, poll_frequency=0.02).until(lambda _: condition())

    def slide_to(self, slot):
        self.script("arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))",
                    self.by_id("slider"), slot)

    def slot(self):
        return int(self.text("slot").split(" of ")[0])

    # What a reader sees

    def uav_cell(self, columns=20, rows=20):
        """Where the middle of the UAV is on the grid as it is drawn, in cells from its lower left corner."""
        uav, grid = self.script(
            "return ['#uav .body', '.grid rect'].map(name => {"
            "  const box = document.querySelector(name).getBoundingClientRect();"
            "  return {x: box.x, y: box.y, width: box.width, height: box.height}})")
        return ((uav["x"] + uav["width"] / 2 - grid["x"]) / grid["width"] * columns - 0.5,
                (grid["y"] + grid["height"] - uav["y"] - uav["height"] / 2) / grid["height"] * rows - 0.5)

    def bars(self):
        """By sensor: number, and length as a share of the room that a bar has."""
        return self.script(
            "return [...document.querySelectorAll('#bar-rows tr')].map(row => {"
            "  const cell = row.cells[1], style = getComputedStyle(cell);"
            "  const padding = parseFloat(style.paddingLeft) + parseFloat(style.paddingRight);"
            "  const bar = cell.firstChild.getBoundingClientRect();"
            "  return [Number(row.cells[2].textContent), bar.width / (cell.clientWidth - padding)]})")

    def shown(self, selector):
        return self.script("return [...document.querySelectorAll(arguments[0])]"
                           ".filter(element => element.getClientRects().length > 0).length", selector)

    def check_slot(self, flight, number):
        """Everything that the page shows of a slot, against the flight."""
        slot = flight[number - 1]
        self.assertEqual(self.text("slot"), f"{number} of {len(flight)}")
        self.assertEqual(self.text("cell"), f"({slot['column']}, {slot['row']})")
        self.assertEqual(self.text("move"), slot["move"])
        scheduled = "none"
        if slot["scheduled"]:
            fate = "collected" if slot["collected"] else "out of coverage"
            scheduled = f"sensor {slot['scheduled']}, {fate}"
        self.assertEqual(self.text("scheduled"), scheduled)
        column, row = self.uav_cell()
        self.assertAlmostEqual(column, slot["column"], delta=0.05)
        self.assertAlmostEqual(row, slot["row"], delta=0.05)
        self.assertEqual(self.text("aoi-now"), f"{sum(slot['aoi']):,}")
        until_now = flight[:number]
        self.assertEqual(self.text("total-aoi"), f"{sum(sum(past['aoi']) for past in until_now):,}")
        largest = max(max(any_slot["aoi"]) for any_slot in flight)
        bars = self.bars()
        self.assertEqual([age for age, _ in bars], slot["aoi"])
        for age, share in bars:
            self.assertAlmostEqual(share, age / largest, delta=0.01)
        cells = [(past["column"], past["row"]) for past in until_now]
        flown = sum(one != other for one, other in zip(cells, cells[1:]))
        self.assertEqual(self.shown("#map .path line"), flown)
        self.assertEqual(self.shown("#map .collection"), sum(past["collected"] for past in until_now))
        collecting = self.script("return [...document.querySelectorAll('#bar-rows .collecting th')]"
                                 ".map(name => name.textContent)")
        self.assertEqual(collecting, [str(slot["scheduled"])] if slot["collected"] else [])
        self.assertEqual(self.shown("#map .sensor.collecting"), len(collecting))

    # The tests

    def test_shows_the_whole_flight_at_first(self):
        self.open("run.html")
        self.assertEqual(self.browser.title, "Three sensors, R = 100 m")
        self.assertEqual(self.text("outcome").split(";")[0], "arrived")
        self.assertIn("total AoI 2,789,", self.text("outcome"))  # the optimum of the paper's field
        self.check_slot(self.flights["exact optimum"], 70)

    def test_the_slider_shows_every_slot_as_it_was_flown(self):
        self.open("run.html")
        flight = self.flights["exact optimum"]
        collecting = next(slot["slot"] for slot in flight if slot["collected"])
        for number in (collecting, 1, 2, 17, 35, 52, 69, 70):
            self.slide_to(number)
            self.check_slot(flight, number)

    def test_a_collection_is_drawn_from_the_uav_to_the_sensor(self):
        self.open("run.html")
        slot = next(slot for slot in self.flights["exact optimum"] if slot["collected"])
        self.slide_to(slot["slot"])
        ends = self.script("""
            const link = document.querySelector('#map > .link');
            const at = (x, y) => {
              const point = new DOMPoint(x.baseVal.value, y.baseVal.value)
                  .matrixTransform(link.getScreenCTM());
              return [point.x, point.y];
            };
            const middle = element => {
              const box = element.getBoundingClientRect();
              return [box.x + box.width / 2, box.y + box.height / 2];
            };
            const sensor = document.querySelectorAll('#map .sensor circle')[arguments[0]];
            return [at(link.x1, link.y1), middle(document.querySelector('#uav .body')),
                    at(link.x2, link.y2), middle(sensor)];""", slot["scheduled"] - 1)
        for found, expected in (ends[:2], ends[2:]):
            self.assertAlmostEqual(found[0], expected[0], delta=1)
            self.assertAlmostEqual(found[1], expected[1], delta=1)

    def test_another_flight_is_shown_at_the_same_slot(self):
        self.open("run.html")
        self.slide_to(30)
        choice = Select(self.by_id("choice"))
        self.assertEqual([option.text for option in choice.options], list(self.flights))
        for name in ("distance-based", "AoI-based", "exact optimum"):
            choice.select_by_visible_text(name)
            self.check_slot(self.flights[name], 30)

    def test_works_with_the_keyboard_alone(self):
        self.open("run.html")
        flight = self.flights["exact optimum"]
        slider = self.by_id("slider")
        body = self.browser.find_element(By.TAG_NAME, "body")
        for _ in range(30):
            body.send_keys(Keys.TAB)
            if self.browser.switch_to.active_element == slider:
                break
        self.assertEqual(self.browser.switch_to.active_element, slider)
        for keys, number in ((Keys.HOME, 1), (Keys.ARROW_RIGHT * 3, 4), (Keys.ARROW_LEFT, 3), (Keys.END, 70)):
            slider.send_keys(keys)
            self.check_slot(flight, number)
        self.assertIn("slot 70 of 70", slider.get_attribute("aria-valuetext"))
        slider.send_keys(Keys.HOME + Keys.SPACE)
        self.wait(lambda: self.slot() >= 3)
        slider.send_keys(Keys.SPACE)
        self.assertEqual(self.text("play"), "Play")
        self.by_id("back").send_keys(Keys.ENTER)
        self.check_slot(flight, self.slot())

    def test_plays_pauses_and_stops_at_the_end(self):
        self.open("run.html")
        play = self.by_id("play")
        play.click()  # from the end: plays from the beginning
        self.assertEqual(play.text, "Pause")
        self.wait(lambda: 3 <= self.slot() < 60)
        play.click()
        self.assertEqual(play.text, "Play")
        paused_at = self.slot()
        self.browser.execute_async_script(  # longer than a slot is played
            "const done = arguments[0]; let frames = 0;"
            "requestAnimationFrame(function next() { ++frames < 40 ? requestAnimationFrame(next) : done() })")
        self.check_slot(self.flights["exact optimum"], paused_at)
        self.slide_to(67)
        play.click()
        self.wait(lambda: play.text == "Play")
        self.check_slot(self.flights["exact optimum"], 70)

    def test_the_readers_hand_takes_over_from_playing(self):
        self.open("run.html")
        self.by_id("play").click()
        self.by_id("forward").click()
        self.assertEqual(self.text("play"), "Play")

    def test_figures_with_the_same_ids_are_both_drawn(self):
        self.open("run.html")
        inked = self.browser.execute_async_script(
            "const done = arguments[0];"
            "Promise.all([...document.querySelectorAll('#figures img')].map(async image => {"
            "  await image.decode();"
            "  const {width, height} = image.getBoundingClientRect();"
            "  const canvas = document.createElement('canvas');"
            "  canvas.width = width; canvas.height = height;"
            "  const context = canvas.getContext('2d');"
            "  context.drawImage(image, 0, 0, width, height);"
            "  const {data} = context.getImageData(0, 0, width, height);"
            "  return data.filter((value, index) => index % 4 === 3 && value > 0).length"
            "})).then(done, error => done(String(error)))")
        self.assertEqual(len(inked), 2)
        self.assertGreater(inked[0], 1000)
        self.assertEqual(inked[0], inked[1])
        for image in self.browser.find_elements(By.CSS_SELECTOR, "#figures img"):
            self.assertGreater(image.size["width"], 300)
            self.assertGreater(image.size["height"], 150)
            self.assertTrue(image.get_attribute("alt"))

    def test_asks_nobody_for_anything(self):
        self.open("run.html")
        self.browser.get_log("performance")
        self.open("run.html")
        events = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [event["params"]["request"]["url"] for event in events
                 if event["method"] == "Network.requestWillBeSent"]
        self.assertIn((self.folder / "run.html").as_uri(), asked)
        self.assertEqual([url for url in asked if not url.startswith(("file:", "data:"))], [])

    def test_fits_a_narrow_screen(self):
        for page in ("run.html", "large.html", "harmful.html"):
            for width in (360, 800):
                self.display(width)
                self.open(page)
                self.assertLessEqual(self.script("return document.documentElement.scrollWidth"), width, page)
        self.display(360)
        self.open("run.html")
        self.slide_to(20)
        self.check_slot(self.flights["exact optimum"], 20)

    def test_text_stands_out_in_light_and_dark(self):
        for scheme in ("light", "dark"):
            self.display(1280, scheme)
            self.open("run.html")
            contrasts = self.script("""
                const channels = text => text.match(/[\\d.]+/g).map(Number);
                const light = text => channels(text).slice(0, 3).map(value => value / 255)
                    .map(value => value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4)
                    .reduce((sum, value, index) => sum + value * [0.2126, 0.7152, 0.0722][index], 0);
                const ground = element => {
                  const color = getComputedStyle(element).backgroundColor;
                  return channels(color)[3] === 0 ? ground(element.parentElement) : color;
                };
                const found = ['h1', '.summary', 'nav a', 'caption', 'td', 'thead th', 'figcaption p',
                               '#outcome', '#play', '#choice', '#map-figure figcaption', 'dt', 'dd',
                               '.hint', 'footer'];
                return found.map(name => {
                  const element = document.querySelector(name);
                  const pair = [light(getComputedStyle(element).color), light(ground(element))].sort();
                  return [name, (Math.max(...pair) + 0.05) / (Math.min(...pair) + 0.05)];
                });""")
            for name, contrast in contrasts:
                self.assertGreaterEqual(contrast, 4.5, f"{name} in {scheme}")  # WCAG 2, level AA
        self.display(1280)

    def test_250_sensors_and_1000_slots_stay_usable(self):
        self.open("large.html")
        flight = read_flights(self.folder / "large.csv")["AoI-based"]
        for number in (1, 500, 1000):
            self.slide_to(number)
            column, row = self.uav_cell(100, 100)
            self.assertAlmostEqual(column, flight[number - 1]["column"], delta=0.1)
            self.assertAlmostEqual(row, flight[number - 1]["row"], delta=0.1)
            self.assertEqual([age for age, _ in self.bars()], flight[number - 1]["aoi"])
        room, needed = self.script("const bars = arguments[0]; return [bars.clientHeight, bars.scrollHeight]",
                                   self.by_id("bars"))
        self.assertLess(room, 900)
        self.assertGreater(needed, 250 * 15)

    def test_no_text_runs_as_a_script(self):
        self.open("harmful.html")
        self.wait(lambda: len(self.browser.find_elements(By.CSS_SELECTOR, "#figures .error")) == 2)
        self.assertIsNone(self.script("return window.harmed ?? null"))
        harm = "\"'></title></script><script>window.harmed = true</script><!-- {{script}} &amp;"
        self.assertEqual(self.browser.title, harm)
        self.assertEqual(Select(self.by_id("choice")).first_selected_option.text, harm)
        self.assertEqual(self.slot(), 70)

    def test_says_what_is_broken_in_its_data(self):
        page = (self.folder / "run.html").read_text()
        data_begin = page.index('id="flight-data">') + len('id="flight-data">')
        data_end = page.index("</script>", data_begin)
        whole = json.loads(page[data_begin:data_end])

        def broken(change):
            data = json.loads(json.dumps(whole))
            change(data)
            return json.dumps(data)

        cases = {
            "it is no JSON": page[data_begin:data_end - 100],
            "flights: expected a list": broken(lambda data: data.update(flights=[])),
            "world.sensors[1]: expected x_m": broken(lambda data: data["world"]["sensors"][1].pop("x_m")),
            "world.rows: expected a positive": broken(lambda data: data["world"].update(rows=0)),
            "flights[1].flight[7]: expected a cell on the grid of 20 x 20":
                broken(lambda data: data["flights"][1]["flight"][7].update(column=20)),
            "flights[0].flight[3].aoi: expected 3 numbers, found [1,2]":
                broken(lambda data: data["flights"][0]["flight"][3].update(aoi=[1, 2])),
            "flights[0].flight[3].scheduled: expected 0 to 3, found 4":
                broken(lambda data: data["flights"][0]["flight"][3].update(scheduled=4)),
        }
        for expected, data in cases.items():
            (self.folder / "broken.html").write_text(page[:data_begin] + data + page[data_end:])
            self.open("broken.html")
            self.assertIn(expected, self.text("flight-error"))
            self.assertFalse(self.by_id("player").is_displayed(), expected)


if __name__ == "__main__":
    sys.exit(unittest.main())
