"use strict";

/** The table: a click on a heading sorts by its column, a second one the other way round. */
{
  const table = document.getElementById("table");
  const value = (row, column) => row.cells[column].dataset.value;
  const compare = (a, b) => (isNaN(a) || isNaN(b) ? a.localeCompare(b, undefined, { numeric: true }) : a - b);
  for (const head of table.tHead.rows[0].cells) {
    head.querySelector("button")?.addEventListener("click", () => {
      const descending = head.ariaSort === "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      head.ariaSort = descending ? "descending" : "ascending";
      const column = head.cellIndex;
      const rows = [...table.tBodies[0].rows];
      rows.sort((a, b) => compare(value(a, column), value(b, column)) * (descending ? -1 : 1));
      table.tBodies[0].append(...rows);
    });
  }
}

/** The comparer. */
{
  const { size: [width, height], unit, entries } = JSON.parse(document.getElementById("data").textContent);
  const element = (id) => document.getElementById(id);
  const stage = element("stage");
  const divider = element("divider");
  const sides = ["left", "right"].map((side) => ({ select: element(side), image: element(`${side}-picture`) }));

  /** All pictures: [entry, picture], in the order of the menus. */
  const pictures = entries.flatMap((entry) => entry.pictures.map((picture) => ({ entry, picture })));
  const chosen = (side) => pictures[Number(side.select.value)];

  /** What is seen: the divider as a share of the stage, the zoom, and where the picture's corner is, in shares of the stage. */
  const view = { split: 0.5, zoom: 1, x: 0, y: 0 };
  const MAX_ZOOM = 64;
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // --- menus

  function fillMenu(select, initial) {
    for (const kind of new Set(pictures.map(({ picture }) => picture.kind))) {
      const group = document.createElement("optgroup");
      group.label = kind;
      pictures.forEach(({ entry, picture }, index) => {
        if (picture.kind === kind) group.append(new Option(`${entry.name} · ${kind.toLowerCase()}`, String(index)));
      });
      select.append(group);
    }
    select.value = String(initial);
  }

  function show(side) {
    const { entry, picture } = chosen(side);
    side.image.src = picture.uri;
    side.image.alt = `${picture.kind} of ${entry.name}`;
    read(pixel);
  }

  // --- view

  function draw() {
    view.x = clamp(view.x, 1 - view.zoom, 0);
    view.y = clamp(view.y, 1 - view.zoom, 0);
    const percent = 100 * view.split;
    divider.style.left = `${percent}%`;
    divider.setAttribute("aria-valuenow", String(Math.round(percent)));
    divider.setAttribute("aria-valuetext", `${Math.round(percent)} % left picture`);
    element("right-layer").style.clipPath = `inset(0 0 0 ${percent}%)`;
    const box = stage.getBoundingClientRect();
    for (const { image } of sides) {
      image.style.transform = `translate(${view.x * box.width}px, ${view.y * box.height}px) scale(${view.zoom})`;
    }
    stage.classList.toggle("zoomed", view.zoom > 1);
    element("zoom").textContent = `${view.zoom.toFixed(view.zoom < 10 && view.zoom % 1 ? 1 : 0)}×`;
  }

  /** Zooms by a factor so that the point (in shares of the stage) stays where it is. */
  function zoomBy(factor, [x, y] = [0.5, 0.5]) {
    const zoom = clamp(view.zoom * factor, 1, MAX_ZOOM);
    view.x = x - ((x - view.x) / view.zoom) * zoom;
    view.y = y - ((y - view.y) / view.zoom) * zoom;
    view.zoom = zoom;
    draw();
  }

  /** Where a pointer is, in shares of the stage. */
  function position(event) {
    const box = stage.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }

  // --- values

  const half = (bits) => {
    const sign = bits & 0x8000 ? -1 : 1;
    const exponent = (bits >> 10) & 31;
    const fraction = bits & 1023;
    if (exponent === 0) return sign * fraction * 2 ** -24;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
  };

  /** An entry's values at a pixel, in units of the reference's mean; null where they are not in this page. */
  function valuesAt(entry, [x, y]) {
    if (entry.values === "") return null;
    entry.bytes ??= Uint8Array.from(atob(entry.values), (c) => c.charCodeAt(0));
    const first = 6 * (y * width + x);
    return [0, 2, 4].map((offset) => half(entry.bytes[first + offset] | (entry.bytes[first + offset + 1] << 8)));
  }

  /** What a picture shows at a pixel: light, or a technique's relative error. */
  function shownAt({ entry, picture }, at) {
    const values = valuesAt(entry, at);
    if (!values) return ["–", "–", "–", "see the .exr file"];
    const number = (value) => value.toPrecision(3).replace("-", "−");
    if (picture.kind !== "In-scatter") return [...values.map((value) => number(100 * value)), "% of the mean"];
    const base = entry === entries[0] ? [0, 0, 0] : valuesAt(entries[0], at);
    return [...values.map((value, channel) => number(unit * (value + base[channel]))), "W/(m² sr)"];
  }

  let pixel = null;

  function read(at) {
    pixel = at;
    element("pixel").textContent = at ? `pixel ${at[0]}, ${at[1]}` : "pixel –";
    const rows = sides.map((side) => {
      const { entry, picture } = chosen(side);
      const row = document.createElement("tr");
      const head = document.createElement("th");
      head.scope = "row";
      head.textContent = `${side.select.id}: ${entry.name}, ${picture.kind.toLowerCase()}`;
      row.append(head);
      for (const text of at ? shownAt({ entry, picture }, at) : ["–", "–", "–", ""]) row.insertCell().textContent = text;
      return row;
    });
    document.querySelector("#readout tbody").replaceChildren(...rows);
  }

  /** The pixel under a pointer. */
  function pixelAt(event) {
    const [x, y] = position(event);
    const pick = (share, corner, count) => clamp(Math.floor(((share - corner) / view.zoom) * count), 0, count - 1);
    return [pick(x, view.x, width), pick(y, view.y, height)];
  }

  // --- input

  /** Calls `move` with the pointer's way, in shares of the stage, from where it goes down until it is let go. */
  function onDrag(target, move) {
    let last = null;
    target.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      last = position(event);
      target.setPointerCapture(event.pointerId);
      event.stopPropagation();
    });
    target.addEventListener("pointermove", (event) => {
      if (!last) return;
      const [x, y] = position(event);
      move(x - last[0], y - last[1]);
      last = [x, y];
      draw();
    });
    for (const end of ["pointerup", "pointercancel"]) target.addEventListener(end, () => (last = null));
  }

  onDrag(divider, (x) => (view.split = clamp(view.split + x, 0, 1)));
  onDrag(stage, (x, y) => {
    view.x += x;
    view.y += y;
  });

  divider.addEventListener("keydown", (event) => {
    const step = event.shiftKey ? 0.1 : 0.01;
    const split = { ArrowLeft: view.split - step, ArrowRight: view.split + step, Home: 0, End: 1 }[event.key];
    if (split === undefined) return;
    view.split = clamp(split, 0, 1);
    event.preventDefault();
    draw();
  });

  stage.addEventListener("pointermove", (event) => read(pixelAt(event)));
  stage.addEventListener("pointerdown", (event) => read(pixelAt(event)));
  stage.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoomBy(2 ** (-Math.sign(event.deltaY) / 2), position(event));
      read(pixelAt(event));
    },
    { passive: false },
  );
  element("in").addEventListener("click", () => zoomBy(2));
  element("out").addEventListener("click", () => zoomBy(0.5));
  element("fit").addEventListener("click", () => zoomBy(1 / view.zoom));

  const last = pictures.findLastIndex(({ picture }) => picture.kind === "In-scatter");
  sides.forEach((side, index) => {
    fillMenu(side.select, index === 0 ? last : 0);
    side.select.addEventListener("change", () => show(side));
    show(side);
  });
  stage.style.aspectRatio = `${width} / ${height}`;
  stage.style.maxWidth = `calc(85vh * ${width / height})`;
  new ResizeObserver(draw).observe(stage);
  draw();
}
