const WHOLE_FLIGHT_MS = 20000;  // played as long as this, within the limits of a slot
const SHORTEST_SLOT_MS = 40;
const LONGEST_SLOT_MS = 250;

function byId(id) {
  const element = document.getElementById(id);
  if (!element) {
    throw new Error(`the page has no element "${id}"`);
  }
  return element;
}

/** Chooses a flight and a slot of it, and shows them on the map, as bars and in numbers. */
class FlightPlayer {
  constructor({world, flights}) {
    this.world = world;
    this.flights = flights;
    this.map = new FlightMap(byId("map"), world);
    this.bars = new AoiBars(byId("bar-rows"), byId("bar-scale"), world.sensors.length);
    this.timer = null;
    this.writeKeys();
    this.connect();
    this.showFlight(0);
    this.showSlot(this.last);
    this.pause();
  }

  get last() {
    return this.flight.flight.length - 1;
  }

  writeKeys() {
    const {columns, rows, cell_m: cell, coverage_radius_m: radius, slots} = this.world;
    byId("time-scale").style.background = `linear-gradient(to right, ${VIRIDIS.join(", ")})`;
    byId("last-slot").textContent = slots;
    byId("coverage-key").textContent = `covered within ${readable(radius)} m`;
    byId("grid-key").textContent = `${columns} × ${rows} cells of ${cell} m`;
    const onMap = (this.world.map ?? []).join("");
    for (const [kind, {className, name}] of Object.entries(CELL_KINDS)) {
      if (onMap.includes(kind)) {
        const key = document.createElement("span");
        const square = svgElement(key, "svg", {class: "key cells", viewBox: "-8 -8 16 16", "aria-hidden": "true"});
        svgElement(square, "path", {class: className, d: "M-7 -7H7V7H-7Z"});
        key.append(name);
        byId("grid-key").after(key);
      }
    }
  }

  connect() {
    const choice = byId("choice");
    this.flights.forEach((flight, index) => choice.add(new Option(flight.policy, index)));
    choice.addEventListener("change", () => this.showFlight(Number(choice.value)));
    const slider = byId("slider");
    slider.addEventListener("input", () => this.stepTo(Number(slider.value) - 1));
    slider.addEventListener("keydown", (event) => {
      if (event.key === " ") {
        event.preventDefault();
        this.togglePlay();
      }
    });
    byId("play").addEventListener("click", () => this.togglePlay());
    byId("back").addEventListener("click", () => this.stepTo(this.index - 1));
    byId("forward").addEventListener("click", () => this.stepTo(this.index + 1));
  }

  /** Stays at the slot, so that flights can be compared there. */
  showFlight(number) {
    this.flight = this.flights[number];
    this.sums = aoiSums(this.flight);
    this.map.showFlight(this.flight);
    this.bars.showFlight(this.flight);
    byId("slider").max = this.last + 1;
    const {outcome, average_aoi: average, total_aoi: total, residual_energy_j: energy} = this.flight;
    byId("outcome").textContent = `${outcome}; average AoI ${readable(average, 2)}, total AoI ` +
                                  `${readable(total)}, ${readable(energy)} J left`;
    this.showSlot(Math.min(this.index ?? 0, this.last));
  }

  showSlot(index) {
    this.index = index;
    this.map.showSlot(index);
    this.bars.showSlot(index);
    const slot = this.flight.flight[index];
    const cell = `(${slot.column}, ${slot.row})`;
    const total = this.sums.slice(0, index + 1).reduce((sum, aoi) => sum + aoi, 0);
    const slider = byId("slider");
    slider.value = index + 1;
    slider.setAttribute("aria-valuetext", `slot ${slot.slot} of ${this.world.slots}, cell ${cell}`);
    byId("slot").textContent = `${slot.slot} of ${this.world.slots}`;
    byId("cell").textContent = cell;
    byId("move").textContent = slot.move;
    byId("scheduled").textContent = slot.scheduled === 0 ? "none"
        : `sensor ${slot.scheduled}${slot.collected ? ", collected" : ", out of coverage"}`;
    byId("aoi-now").textContent = readable(this.sums[index]);
    byId("total-aoi").textContent = readable(total);
    byId("back").disabled = index === 0;
    byId("forward").disabled = index === this.last;
    byId("map").setAttribute("aria-label", `Map at slot ${slot.slot}: the UAV over cell ${cell}`);
  }

  /** By the reader's hand, which takes over from playing. */
  stepTo(index) {
    this.pause();
    this.showSlot(Math.min(Math.max(index, 0), this.last));
  }

  togglePlay() {
    if (this.timer === null) {
      this.play();
    } else {
      this.pause();
    }
  }

  play() {
    if (this.index === this.last) {
      this.showSlot(0);
    }
    const evenMs = WHOLE_FLIGHT_MS / this.flight.flight.length;
    const slotMs = Math.min(Math.max(evenMs, SHORTEST_SLOT_MS), LONGEST_SLOT_MS);
    this.timer = setInterval(() => this.playOn(), slotMs);
    byId("play").textContent = "Pause";
  }

  playOn() {
    if (this.index < this.last) {
      this.showSlot(this.index + 1);
    }
    if (this.index === this.last) {
      this.pause();
    }
  }

  pause() {
    clearInterval(this.timer);
    this.timer = null;
    byId("play").textContent = "Play";
  }
}

function showFlights() {
  try {
    const flightData = readFlightData(byId("flight-data").textContent);
    byId("player").hidden = false;
    new FlightPlayer(flightData);
  } catch (error) {
    byId("player").hidden = true;
    const note = byId("flight-error");
    note.hidden = false;
    note.textContent = `The flights can't be shown; the page's flight data is broken. ${error.message}. ` +
                       "Write the report again.";
  }
}

showFlights();
