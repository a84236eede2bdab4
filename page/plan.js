// Shows the plan in #data: the arm at the slider's moment, and that moment in the plots.
"use strict";

const plan = JSON.parse(document.getElementById("data").textContent);
const element = (id) => document.getElementById(id);
const last = plan.times.length - 1;
const OKABE_ITO = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7"];
const STYLE = { displayModeBar: false, responsive: true };

// --- the arm in space ---

const corners = plan.shapes.flatMap((shape) => shape.vertices.map((p) => [shape.frame, p]));

// Where all corners of the arm are at a moment: x, y and z, m.
function placed(moment) {
  const frames = plan.frames[moment];
  const along = (row) =>
    corners.map(([frame, p]) => {
      const r = frames[frame][row];
      return r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
    });
  return { x: along(0), y: along(1), z: along(2) };
}

function arm(moment, opacity) {
  const mesh = { type: "mesh3d", ...placed(moment), i: [], j: [], k: [], facecolor: [] };
  let first = 0;
  for (const shape of plan.shapes) {
    for (const [i, j, k] of shape.triangles) {
      mesh.i.push(first + i);
      mesh.j.push(first + j);
      mesh.k.push(first + k);
      mesh.facecolor.push(shape.colour);
    }
    first += shape.vertices.length;
  }
  const lighting = { ambient: 0.6, diffuse: 0.7, specular: 0.1 };
  return { ...mesh, opacity, flatshading: true, hoverinfo: "skip", lighting };
}

// Points [x, y, z] as a trace of plotly.
function through(points, style) {
  const [x, y, z] = [0, 1, 2].map((axis) => points.map((p) => p[axis]));
  return { type: "scatter3d", x, y, z, hoverinfo: "skip", ...style };
}

function drawScene() {
  const ways = plan.segments.map((segment, i) =>
    through(segment.tool, {
      mode: "lines",
      name: segment.kind,
      legendgroup: segment.kind,
      showlegend: plan.segments.findIndex((other) => other.kind === segment.kind) === i,
      line: { color: segment.colour, width: 6 },
    }));
  const targets = through(plan.checkpoints.slice(1), {
    mode: "markers+text",
    name: "targets, as visited",
    text: plan.checkpoints.slice(1).map((_, i) => `<b>${i + 1}</b>`),
    textfont: { size: 16 },
    marker: { size: 5, color: "#000000" },
  });
  const ghost = { ...arm(last, 0.2), name: "arm at the goal", showlegend: true };
  const axis = (name, i) => ({ title: { text: `${name} (m)` }, range: extent(i), gridcolor: "#ddd" });
  const layout = {
    margin: { l: 0, r: 0, t: 0, b: 0 },
    legend: { x: 0, y: 1, bgcolor: "rgba(255,255,255,0.7)" },
    scene: {
      aspectmode: "data",
      xaxis: axis("x", 0),
      yaxis: axis("y", 1),
      zaxis: axis("z", 2),
      camera: { eye: towards(plan.checkpoints), center: { x: 0, y: 0, z: -0.1 } },
    },
  };
  return Plotly.newPlot("scene", [arm(0, 1), ghost, ...ways, targets], layout, STYLE);
}

// From where to where the arm gets along an axis, m: fixed, or the view would jump while it moves.
function extent(axis) {
  const room = 0.1; // as far as the arm's shapes are from its frames
  const all = plan.frames.flatMap((frames) => frames.map((rows) => rows[axis][3]));
  const [least, most] = all.reduce(([low, high], x) => [Math.min(low, x), Math.max(high, x)], [0, 0]);
  return [axis === 2 ? 0 : least - room, most + room];
}

// Where to look from: the side on which most of the tour is, a little from above and beside.
function towards(points) {
  const mean = (axis) => points.reduce((sum, p) => sum + p[axis], 0) / points.length;
  const angle = Math.atan2(mean(1), mean(0)) + 0.6;
  return { x: 1.45 * Math.cos(angle), y: 1.45 * Math.sin(angle), z: 0.6 };
}

// --- over time ---

// Joints as percentages of their ranges, so that all limits are at 0 and 100.
function jointLines() {
  const { names, positions, lower, upper } = plan.joints;
  return positions.map((q, i) => ({
    name: names[i],
    y: q.map((value) => (100 * (value - lower[i])) / (upper[i] - lower[i])),
    customdata: q,
    hovertemplate: "%{customdata:.3f} rad",
    line: { color: OKABE_ITO[i], width: 1.8 },
    legend: "legend",
  }));
}

function plotLines() {
  const percent = (values) => values.map((value) => 100 * value);
  const { velocity, acceleration } = plan.effort;
  const unit = "%{y:.4g}";
  const lines = [
    ...jointLines().map((line) => ({ ...line, yaxis: "y" })),
    { name: "velocity", y: percent(velocity), yaxis: "y2", line: { color: "#0072B2" }, legend: "legend2" },
    { name: "acceleration", y: percent(acceleration), yaxis: "y2", line: { color: "#E69F00", width: 1 },
      legend: "legend2" },
    { name: "off the line", y: plan.distance, yaxis: "y3", line: { color: "#0072B2" }, showlegend: false },
    { name: "singular value", y: plan.singular_value, yaxis: "y4", line: { color: "#0072B2" },
      showlegend: false },
  ];
  return lines.map((line) => ({ hovertemplate: unit, ...line, x: plan.times, type: "scatter", mode: "lines" }));
}

// The kinds of the segments as bands, under all plots.
function bands() {
  return plan.segments.map((segment) => ({
    type: "rect", layer: "below", xref: "x", yref: "paper", y0: 0, y1: 1, line: { width: 0 },
    x0: segment.start, x1: segment.end, fillcolor: segment.colour, opacity: segment.kind === "line" ? 0.05 : 0.2,
  }));
}

function drawPlots() {
  const cursor = { type: "line", xref: "x", yref: "paper", x0: 0, x1: 0, y0: 0, y1: 1, line: { width: 1.5 } };
  const axis = (title, top, bottom, more) => ({
    title: { text: title, standoff: 6 }, domain: [bottom, top], anchor: "x", gridcolor: "#e8e8e8", ...more });
  const offLine = plan.distance.reduce((most, mm) => Math.max(most, mm), 0.01); // 0.01 mm at least
  const legend = (y) => ({ orientation: "h", x: 1, xanchor: "right", y, yanchor: "bottom", font: { size: 11 } });
  const layout = {
    margin: { l: 60, r: 10, t: 30, b: 40 },
    hovermode: "x unified",
    shapes: [cursor, ...bands()],
    xaxis: { title: { text: "time (s)" }, range: [0, plan.times[last]], anchor: "y4", gridcolor: "#e8e8e8" },
    yaxis: axis("% of joint's range", 1, 0.64, { range: [-4, 104] }),
    yaxis2: axis("% of limit", 0.57, 0.41, { range: [0, 112] }),
    yaxis3: axis("off line (mm)", 0.36, 0.21, { range: [0, 1.1 * offLine], exponentformat: "none" }),
    yaxis4: axis("smallest σ (m/rad)", 0.16, 0, { rangemode: "tozero" }),
    legend: legend(1.0),
    legend2: legend(0.57),
  };
  return Plotly.newPlot("plots", plotLines(), layout, STYLE);
}

// --- tables: text only ever by textContent, since a bag may have any name ---

function row(table, cells) {
  const line = table.tBodies[0].insertRow();
  cells.forEach((text) => { line.insertCell().textContent = text; });
  return line;
}

function fillTables() {
  element("title").textContent = plan.title;
  plan.report.forEach((cells) => row(element("report"), cells));
  plan.segments.forEach((segment) => {
    const between = `${segment.from} to ${segment.to}`;
    const during = `${segment.start.toFixed(2)} to ${segment.end.toFixed(2)} s`;
    const line = row(element("segments"), [segment.kind, between, during]);
    const chip = document.createElement("span");
    chip.className = "chip";
    chip.style.background = segment.colour;
    line.cells[0].prepend(chip);
    line.title = segment.reason;
    line.tabIndex = 0;
    line.onclick = () => goTo(segment.start + 1e-9);
    line.onkeydown = (event) => { if (event.key === "Enter") line.onclick(); };
  });
}

// --- the moment that is shown ---

const nearest = (time) => Math.min(last, Math.max(0, Math.round((time / plan.times[last]) * last)));

function show(moment) {
  const time = plan.times[moment];
  const { x, y, z } = placed(moment);
  const current = plan.segments.findIndex((segment) => time < segment.end);
  const i = current < 0 ? plan.segments.length - 1 : current;
  element("time").value = moment;
  element("now").value = `${time.toFixed(2)} of ${plan.times[last].toFixed(2)} s`;
  [...element("segments").tBodies[0].rows].forEach((line, at) => line.setAttribute("aria-current", at === i));
  return Promise.all([
    Plotly.restyle("scene", { x: [x], y: [y], z: [z] }, [0]),
    Plotly.relayout("plots", { "shapes[0].x0": time, "shapes[0].x1": time }),
  ]);
}

function goTo(time) {
  return show(nearest(time));
}

let playing = false;

// Goes on from the slider's moment in real time, times the speed, to the end.
function play() {
  playing = !playing;
  element("play").textContent = playing ? "pause" : "play";
  if (!playing) return;
  if (Number(element("time").value) === last) show(0);
  let time = plan.times[Number(element("time").value)];
  let before = performance.now();
  const step = (now) => {
    if (!playing) return;
    time += (Math.max(0, now - before) / 1000) * Number(element("speed").value);
    before = now;
    const drawn = goTo(time); // a slow computer leaves moments out
    if (time >= plan.times[last]) play();
    else drawn.then(() => requestAnimationFrame(step));
  };
  requestAnimationFrame(step);
}

function begin() {
  element("time").max = last;
  element("time").oninput = () => show(Number(element("time").value));
  element("play").onclick = play;
  element("plots").on("plotly_click", (event) => goTo(event.points[0].x));
  show(0);
  document.body.dataset.ready = "true";
}

fillTables();
Promise.all([drawScene(), drawPlots()]).then(begin);
