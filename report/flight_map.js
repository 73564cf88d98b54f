/** Viridis, from 0 to 1: evenly bright steps, also to the colour-blind. */
const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58",
                 "#b5de2b", "#fde725"];

function viridis(fraction) {
  const position = Math.min(Math.max(fraction, 0), 1) * (VIRIDIS.length - 1);
  const lower = Math.min(Math.floor(position), VIRIDIS.length - 2);
  const channels = [1, 3, 5].map((at) => {
    const [from, to] = [lower, lower + 1].map((step) => parseInt(VIRIDIS[step].slice(at, at + 2), 16));
    return Math.round(from + (to - from) * (position - lower));
  });
  return `rgb(${channels.join(" ")})`;
}

function svgElement(parent, tag, attributes = {}, text = "") {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) {
    element.setAttribute(name, value);
  }
  element.textContent = text;
  parent.append(element);
  return element;
}

/** The smallest of 1, 2, 5, 10, 20 ... that cuts `length` into at most `most` parts. */
function gridStep(length, most) {
  for (let power = 1;; power *= 10) {
    for (const step of [power, 2 * power, 5 * power]) {
      if (length / step <= most) {
        return step;
      }
    }
  }
}

const CELL = 10;          // units of the drawing a cell
const DENSE = 40;         // columns or rows: the path over more of them is drawn thinner
const NUMBERED = 60;      // sensors: more of them are dots without a number
const FILLED = 25;        // sensors: the coverage of more of them is drawn as outlines only

/** Cells of a map that are not just free: their class in the drawing, and what they are. */
const CELL_KINDS = {
  N: {className: "no-flying", name: "no flying"},
  R: {className: "blocks-radio", name: "blocks radio"},
  B: {className: "blocks-both", name: "no flying, blocks radio"},
  S: {className: "zone", name: "start and landing"},
};

/**
 * The field seen from above, row 0 at the bottom. Positions are in units of the drawing; marks are
 * drawn in pixels of the screen, whatever the size of the map.
 */
class FlightMap {
  constructor(svg, world) {
    this.svg = svg;
    this.world = world;
    this.width = world.columns * CELL;
    this.height = world.rows * CELL;
    this.dense = Math.max(world.columns, world.rows) > DENSE;
    svg.classList.toggle("dense", this.dense);
    const margin = 0.065 * Math.max(this.width, this.height);
    svg.setAttribute("viewBox", `${-margin} ${-margin / 4} ${this.width + 1.25 * margin} ` +
                                `${this.height + 1.25 * margin}`);
    this.drawObstacles();
    this.drawGrid();
    this.drawCoverage();
    this.casings = svgElement(svg, "g", {class: "casings"});
    this.path = svgElement(svg, "g", {class: "path"});
    this.collections = svgElement(svg, "g");
    this.link = svgElement(svg, "line", {class: "link"});
    this.drawSensors();
    this.drawEnds();
    this.drawUav();
    new ResizeObserver(() => this.keepMarksInPixels()).observe(svg);
  }

  /** The place of a cell's centre; columns and rows may be fractions. */
  place(column, row) {
    return {x: (column + 0.5) * CELL, y: this.height - (row + 0.5) * CELL};
  }

  placeOfSensor(sensor) {
    return this.place(sensor.x_m / this.world.cell_m, sensor.y_m / this.world.cell_m);
  }

  /** A group whose origin is at the place and whose unit is a pixel. */
  mark(parent, place, className, title = "") {
    const outer = svgElement(parent, "g", {transform: `translate(${place.x} ${place.y})`});
    const inner = svgElement(outer, "g", {class: `mark ${className}`});
    if (title) {
      svgElement(inner, "title", {}, title);
    }
    return inner;
  }

  keepMarksInPixels() {
    const scale = this.svg.getScreenCTM()?.a;
    if (scale > 0) {
      this.svg.style.setProperty("--pixel", 1 / scale);
    }
  }

  drawObstacles() {
    const group = svgElement(this.svg, "g", {class: "cells"});
    for (const [kind, {className, name}] of Object.entries(CELL_KINDS)) {
      let cells = "";
      (this.world.map ?? []).forEach((row, fromNorth) => {
        [...row].forEach((cell, column) => {
          if (cell === kind) {
            cells += `M${column * CELL} ${fromNorth * CELL}h${CELL}v${CELL}h${-CELL}z`;
          }
        });
      });
      if (cells) {
        svgElement(svgElement(group, "path", {class: className, d: cells}), "title", {}, name);
      }
    }
  }

  drawGrid() {
    const {columns, rows} = this.world;
    const grid = svgElement(this.svg, "g", {class: "grid"});
    svgElement(grid, "rect", {width: this.width, height: this.height});
    const longest = Math.max(columns, rows);
    const step = gridStep(longest, 25);
    let lines = "";
    for (let column = step; column < columns; column += step) {
      lines += `M${column * CELL} 0V${this.height}`;
    }
    for (let row = step; row < rows; row += step) {
      lines += `M0 ${this.height - row * CELL}H${this.width}`;
    }
    svgElement(grid, "path", {d: lines});
    const labelStep = gridStep(longest, 5);
    for (let column = 0; column < columns; column += labelStep) {
      const mark = this.mark(grid, {x: this.place(column, 0).x, y: this.height}, "tick");
      svgElement(mark, "text", {y: 14, "text-anchor": "middle"}, column);
    }
    for (let row = 0; row < rows; row += labelStep) {
      const mark = this.mark(grid, {x: 0, y: this.place(0, row).y}, "tick");
      svgElement(mark, "text", {x: -4, y: 4, "text-anchor": "end"}, row);
    }
  }

  drawCoverage() {
    const clip = svgElement(svgElement(this.svg, "defs"), "clipPath", {id: "field"});
    svgElement(clip, "rect", {width: this.width, height: this.height});
    const group = svgElement(this.svg, "g", {"clip-path": "url(#field)"});
    const radius = this.world.coverage_radius_m / this.world.cell_m * CELL;
    group.classList.toggle("outlines", this.world.sensors.length > FILLED);
    this.coverage = this.world.sensors.map((sensor) => {
      const {x, y} = this.placeOfSensor(sensor);
      return svgElement(group, "circle", {class: "coverage", cx: x, cy: y, r: radius});
    });
  }

  drawEnds() {
    const {start, stop, columns} = this.world;
    const same = start.column === stop.column && start.row === stop.row;
    const ends = same ? [["start and stop", start]] : [["start", start], ["stop", stop]];
    for (const [name, cell] of ends) {
      const mark = this.mark(this.svg, this.place(cell.column, cell.row), "end");
      svgElement(mark, "rect", {x: -6, y: -6, width: 12, height: 12});
      const right = cell.column < columns / 2;
      svgElement(mark, "text", {x: right ? 16 : -16, y: 4, "text-anchor": right ? "start" : "end"}, name);
    }
  }

  drawSensors() {
    const numbered = this.world.sensors.length <= NUMBERED;
    this.sensors = this.world.sensors.map((sensor, index) => {
      const title = `sensor ${index + 1} at (${sensor.x_m} m, ${sensor.y_m} m)`;
      const mark = this.mark(this.svg, this.placeOfSensor(sensor), "sensor", title);
      svgElement(mark, "circle", {r: numbered ? 9 : 3.5});
      if (numbered) {
        svgElement(mark, "text", {y: 3.5, "text-anchor": "middle"}, index + 1);
      }
      return mark;
    });
  }

  drawUav() {
    this.uav = svgElement(this.svg, "g", {id: "uav"});
    const mark = svgElement(this.uav, "g", {class: "mark"});
    for (const style of ["halo", "body"]) {
      const group = svgElement(mark, "g", {class: style});
      svgElement(group, "path", {d: "M-8 -8L8 8M-8 8L8 -8"});
      for (const [cx, cy] of [[-8, -8], [8, -8], [-8, 8], [8, 8], [0, 0]]) {
        svgElement(group, "circle", {cx, cy, r: 4.5});
      }
    }
  }

  showFlight(flight) {
    this.flight = flight;
    for (const group of [this.casings, this.path, this.collections]) {
      group.replaceChildren();
    }
    this.marks = flight.flight.map((slot, index) => this.drawSlot(slot, flight.flight[index - 1]));
  }

  /** What a slot adds to the map: the way to it from the slot before, and what is collected in it. */
  drawSlot(slot, before) {
    const added = [];
    const here = this.place(slot.column, slot.row);
    const time = viridis((slot.slot - 1) / (this.world.slots - 1));
    if (before && (before.column !== slot.column || before.row !== slot.row)) {
      const from = this.place(before.column, before.row);
      const line = {x1: from.x, y1: from.y, x2: here.x, y2: here.y};
      added.push(svgElement(this.casings, "line", line),
                 svgElement(this.path, "line", {...line, stroke: time}));
    }
    if (slot.collected) {
      const mark = this.mark(this.collections, here, "collection",
                             `slot ${slot.slot}: sensor ${slot.scheduled} collected`);
      svgElement(mark, "circle", {r: this.dense ? 2.2 : 4, fill: time});
      added.push(mark.parentNode);
    }
    return added;
  }

  showSlot(index) {
    const slot = this.flight.flight[index];
    this.marks.forEach((added, at) => {
      added.forEach((element) => element.classList.toggle("later", at > index));
    });
    const here = this.place(slot.column, slot.row);
    this.uav.setAttribute("transform", `translate(${here.x} ${here.y})`);
    const collected = slot.collected ? slot.scheduled - 1 : -1;
    const there = slot.collected ? this.placeOfSensor(this.world.sensors[collected]) : here;
    for (const [name, value] of Object.entries({x1: here.x, y1: here.y, x2: there.x, y2: there.y})) {
      this.link.setAttribute(name, value);
    }
    for (const marks of [this.sensors, this.coverage]) {
      marks.forEach((mark, sensor) => mark.classList.toggle("collecting", sensor === collected));
    }
  }
}
