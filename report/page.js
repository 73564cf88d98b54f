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

/** The configuration is printed, too. */
function openForPrint() {
  const details = document.querySelectorAll("details:not([open])");
  addEventListener("beforeprint", () => details.forEach((element) => { element.open = true; }));
  addEventListener("afterprint", () => details.forEach((element) => { element.open = false; }));
}

document.querySelectorAll("#figures img").forEach(checkFigure);
openForPrint();
