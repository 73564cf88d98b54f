/** A figure that the browser can't read says so. */
async function checkFigure(image) {
  try {
    await image.decode();
  } catch {
    const note = document.createElement("p");
    note.className = "error";
    note.textContent = "This figure can't be shown: its SVG document is broken.";
    image.replaceWith(note);
  }
}

function showFlights() {
  const data = document.getElementById("flight-data");
  if (!data) {
    return;  // a report without flights
  }
  try {
    const flightData = readFlightData(data.textContent);
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

/** The configuration is printed, too. */
function openForPrint() {
  const details = document.querySelectorAll("details:not([open])");
  addEventListener("beforeprint", () => details.forEach((element) => { element.open = true; }));
  addEventListener("afterprint", () => details.forEach((element) => { element.open = false; }));
}

document.querySelectorAll("#figures img").forEach(checkFigure);
openForPrint();
showFlights();
