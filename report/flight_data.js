"use strict";

function expectThat(condition, where, expected, found) {
  if (!condition) {
    throw new Error(`${where}: expected ${expected}, found ${JSON.stringify(found) ?? "nothing"}`);
  }
}

function expectList(list, where) {
  expectThat(Array.isArray(list) && list.length > 0, where, "a list with entries", list);
}

function expectCell(cell, world, where) {
  const onGrid = Number.isInteger(cell?.column) && cell.column >= 0 && cell.column < world.columns &&
                 Number.isInteger(cell.row) && cell.row >= 0 && cell.row < world.rows;
  expectThat(onGrid, where, `a cell on the grid of ${world.columns} x ${world.rows}`,
             cell && {column: cell.column, row: cell.row});
}

function expectWorld(world) {
  for (const field of ["columns", "rows", "cell_m", "slots", "coverage_radius_m"]) {
    expectThat(world?.[field] > 0, `world.${field}`, "a positive number", world?.[field]);
  }
  expectCell(world.start, world, "world.start");
  expectCell(world.stop, world, "world.stop");
  expectList(world.sensors, "world.sensors");
  world.sensors.forEach((sensor, index) => {
    const placed = Number.isFinite(sensor?.x_m) && Number.isFinite(sensor.y_m);
    expectThat(placed, `world.sensors[${index}]`, "x_m and y_m in metres", sensor);
  });
}

/** The rows of the map, the northern one first; undefined if the grid is open. */
function expectMap(world) {
  const {map, columns, rows} = world;
  const sound = map === undefined || (Array.isArray(map) && map.length === rows &&
                map.every((row) => typeof row === "string" && row.length === columns && /^[.NRBS]*$/.test(row)));
  expectThat(sound, "world.map", `${rows} texts of ${columns} cells`, map);
}

function expectSlot(slot, world, where) {
  const sensors = world.sensors.length;
  expectCell(slot, world, where);
  expectThat(Number.isInteger(slot.slot), `${where}.slot`, "a whole number", slot.slot);
  expectThat(typeof slot.move === "string", `${where}.move`, "the name of a move", slot.move);
  expectThat(Number.isInteger(slot.scheduled) && slot.scheduled >= 0 && slot.scheduled <= sensors,
             `${where}.scheduled`, `0 to ${sensors}`, slot.scheduled);
  expectThat(Array.isArray(slot.aoi) && slot.aoi.length === sensors && slot.aoi.every(Number.isFinite),
             `${where}.aoi`, `${sensors} numbers`, slot.aoi);
}

/** The world and its flights from the page's JSON. Throws an Error that says what is broken, and where. */
function readFlightData(text) {
  let data;
  try {
    data = JSON.parse(text);
  } catch (error) {
    throw new Error(`it is no JSON (${error.message})`);
  }
  expectWorld(data?.world);
  expectMap(data.world);
  expectList(data.flights, "flights");
  data.flights.forEach((flight, index) => {
    expectList(flight?.flight, `flights[${index}].flight`);
    flight.flight.forEach((slot, at) => expectSlot(slot, data.world, `flights[${index}].flight[${at}]`));
  });
  return data;
}

/** Of what the slots say: the sum of the AoI of all sensors, slot by slot. */
function aoiSums(flight) {
  return flight.flight.map((slot) => slot.aoi.reduce((sum, aoi) => sum + aoi, 0));
}

/** For a person: 12345.678 with one decimal is "12,345.7". */
function readable(number, decimals = 0) {
  return number.toLocaleString("en", {minimumFractionDigits: decimals, maximumFractionDigits: decimals});
}
