/** The AoI of every sensor as a bar with its number; the scale is the largest AoI of the flight. */
class AoiBars {
  constructor(rows, scale, sensors) {
    this.scale = scale;
    this.sensors = Array.from({length: sensors}, (_, index) => {
      const row = rows.insertRow();
      const name = document.createElement("th");
      name.scope = "row";
      name.textContent = index + 1;
      row.append(name);
      const bar = document.createElement("div");
      bar.className = "bar";
      row.insertCell().append(bar);
      const number = row.insertCell();
      number.className = "number";
      return {row, bar, number};
    });
  }

  showFlight(flight) {
    this.flight = flight;
    this.largest = Math.max(1, ...flight.flight.map((slot) => Math.max(...slot.aoi)));
    this.scale.textContent = `(bars: 0 to ${this.largest})`;
  }

  showSlot(index) {
    const slot = this.flight.flight[index];
    this.sensors.forEach(({row, bar, number}, sensor) => {
      bar.style.width = `${100 * slot.aoi[sensor] / this.largest}%`;
      number.textContent = slot.aoi[sensor];
      row.classList.toggle("collecting", slot.collected && slot.scheduled === sensor + 1);
    });
  }
}
