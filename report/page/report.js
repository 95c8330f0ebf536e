// Draws the figures of the page from the data in the page; no other file is needed.
"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const plots = [], views = [];

  // ---- Lists of numbers, packed by report/figures/packed_numbers.h
  const unpacked = new Map();

  function bytesOf(text) {
    const raw = atob(text), bytes = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
    return bytes.buffer;
  }

  function unpack(entry) {
    if (entry.f64 !== undefined) return new Float64Array(bytesOf(entry.f64));
    if (entry.f32 !== undefined) return new Float32Array(bytesOf(entry.f32));
    return Float64Array.from({ length: entry.n }, (_, i) => entry.first + i / entry.rate);
  }

  function numbers(index) {
    if (!unpacked.has(index)) unpacked.set(index, unpack(data.numbers[index]));
    return unpacked.get(index);
  }

  // ---- CSV, identical to the output of report::to_csv

  // The shortest text that reads back to the same double, as C++'s std::to_chars chooses it.
  function exact(value) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? "nan" : value > 0 ? "inf" : "-inf";
    if (value === 0) return Object.is(value, -0) ? "-0" : "0";
    const sign = value < 0 ? "-" : "";
    const [mantissa, power] = Math.abs(value).toExponential().split("e");
    const digits = mantissa.replace(".", ""), n = digits.length;
    const exponent = Number(power) - (n - 1), single = n === 1 ? 1 : 0;
    if (exponent < -(n + 3) + single || exponent > 5 - single)
      return sign + mantissa + "e" + power[0] + power.slice(1).padStart(2, "0");
    if (exponent >= 0) return sign + BigInt(Math.abs(value)).toString();
    const point = n + exponent;
    if (point > 0) return sign + digits.slice(0, point) + "." + digits.slice(point);
    return sign + "0." + "0".repeat(-point) + digits;
  }

  function entryText(list, i) {
    const text = exact(list[i]);
    if (text !== "nan") return text;
    const size = list.BYTES_PER_ELEMENT;
    const top = new Uint8Array(list.buffer)[size * (i + 1) - 1];
    return top & 0x80 ? "-nan" : text;
  }

  function figureCsv(figure) {
    const lines = ["panel,curve,x_name,x,y_name,y,y_low,y_high\n"];
    figure.panels.forEach((panel, p) => {
      for (const curve of panel.curves) {
        const [label, xName, yName] = curve.csv;
        const x = numbers(curve.x), band = curve.style === "band";
        const y = band ? null : numbers(curve.y);
        const low = band ? numbers(curve.y_low) : null, high = band ? numbers(curve.y_high) : null;
        for (let i = 0; i < x.length; ++i) {
          const end = band ? "," + entryText(low, i) + "," + entryText(high, i) : entryText(y, i) + ",,";
          lines.push(p + 1 + "," + label + "," + xName + "," + entryText(x, i) + "," + yName + "," + end + "\n");
        }
      }
    });
    return lines.join("");
  }

  function csvOf(kind, number) {
    const entry = data[kind][number];
    if (kind === "figures") return { name: entry.name, text: figureCsv(entry) };
    if (kind === "views") return views[number].csv();
    return { name: entry.name, text: entry.csv };
  }

  function save({ name, text }) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
    link.download = name + ".csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  for (const button of document.querySelectorAll("button[data-save]"))
    button.addEventListener("click", () => save(csvOf(button.dataset.save, Number(button.dataset.number))));

  // ---- Light and dark
  const prefersDark = matchMedia("(prefers-color-scheme: dark)");
  let printing = false;

  function isDark() {
    if (printing) return false;
    return root.dataset.theme ? root.dataset.theme === "dark" : prefersDark.matches;
  }

  // A colour of the palette with enough contrast: dark colours are lightened on a dark page, yellow is darkened on a light page.
  function curveColour(number) {
    const rgb = data.palette[number % data.palette.length];
    const light = (0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]) / 255;
    const mix = isDark() ? Math.max(0, 0.62 - light) / (1.001 - light) : 0;
    const scale = !isDark() && light > 0.8 ? 0.75 : 1;
    return "rgb(" + rgb.map((c) => Math.round(scale * (c + mix * (255 - c)))).join(",") + ")";
  }

  const paint = (name) => getComputedStyle(root).getPropertyValue(name).trim();

  function applyTheme() {
    const button = document.getElementById("theme");
    button.setAttribute("aria-pressed", String(isDark()));
    for (const plot of plots) plot.colour();
    for (const view of views) view.colour();
  }

  document.getElementById("theme").addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    applyTheme();
  });
  prefersDark.addEventListener("change", applyTheme);

  // ---- Words and elements
  function element(tag, attributes, ...children) {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) made.setAttribute(name, value);
    made.append(...children);
    return made;
  }

  const superscripts = { "-": "\u207b", 0: "\u2070", 1: "\u00b9", 2: "\u00b2", 3: "\u00b3", 4: "\u2074", 5: "\u2075", 6: "\u2076", 7: "\u2077", 8: "\u2078", 9: "\u2079" };

  function rounded(value, digits) {
    if (!Number.isFinite(value)) return "\u2013";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits)));
    const [mantissa, power] = value.toExponential(digits - 1).split("e");
    const raised = String(Number(power)).replace(/./g, (c) => superscripts[c]);
    const factor = String(Number(mantissa));
    return (factor === "1" ? "" : factor === "-1" ? "-" : factor + "\u00b7") + "10" + raised;
  }

  // ---- One panel
  const low = 0, middle = 1, high = 2;

  function usable(value, log) {
    return Number.isFinite(value) && !(log && value <= 0);
  }

  // Range of x over all curves.
  function extentOf(curves, panel) {
    let [least, most] = panel.x_range || [Infinity, -Infinity];
    for (const curve of curves)
      for (const x of numbers(curve.x)) {
        if (!usable(x, panel.log_x)) continue;
        least = Math.min(least, x);
        most = Math.max(most, x);
      }
    return [least, most];
  }

  // The curve's points that the axis can show, with ascending x; y is a number, or low, middle, high.
  function pointsOf(curve, panel, bars) {
    const x = numbers(curve.x), band = curve.style === "band";
    const yLow = numbers(band ? curve.y_low : curve.y), yHigh = band ? numbers(curve.y_high) : yLow;
    const order = [];
    let ascending = true;
    for (let i = 0; i < x.length; ++i) {
      if (!usable(x[i], panel.log_x)) continue;
      if (order.length && x[i] < x[order[order.length - 1]]) ascending = false;
      order.push(i);
    }
    if (!ascending) order.sort((a, b) => x[a] - x[b]);
    const points = order.map((i) => {
      if (!usable(yLow[i], panel.log_y) || !usable(yHigh[i], panel.log_y)) return [x[i], bars ? [NaN, NaN, NaN] : NaN];
      const centre = panel.log_y ? Math.sqrt(yLow[i] * yHigh[i]) : 0.5 * (yLow[i] + yHigh[i]);
      return [x[i], bars ? [yLow[i], centre, yHigh[i]] : yLow[i]];
    });
    return { points, scattered: !ascending };
  }

  // Linear interpolation of a band at points that only other curves have.
  function between(before, after, x) {
    if (!before || !after) return null;
    const part = (x - before[0]) / (after[0] - before[0]);
    return [low, middle, high].map((k) => before[1][k] + part * (after[1][k] - before[1][k]));
  }

  // All curves as rows of one table sorted by x; the curves need not have the same x.
  function rowsOf(curves, bands) {
    const together = curves.every((points) => points.length === curves[0].length) &&
      curves.slice(1).every((points) => points.every((point, i) => point[0] === curves[0][i][0]));
    if (together && curves.length) return curves[0].map((point, i) => [point[0]].concat(curves.map((points) => points[i][1])));
    const at = curves.map(() => 0), rows = [];
    while (true) {
      let x = Infinity;
      curves.forEach((points, c) => { if (at[c] < points.length) x = Math.min(x, points[at[c]][0]); });
      if (x === Infinity) return rows;
      rows.push([x].concat(curves.map((points, c) => {
        if (at[c] < points.length && points[at[c]][0] === x) return points[at[c]++][1];
        return bands[c] ? between(points[at[c] - 1], points[at[c]], x) : null;
      })));
    }
  }

  // Ticks at divisions of a circle.
  function circleTicks(from, to, pixels) {
    const steps = [1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720];
    const step = steps.find((s) => (to - from) / s <= Math.max(2, pixels / 30)) || 1440;
    const ticks = [];
    for (let v = Math.ceil(from / step) * step; v <= to; v += step) ticks.push({ v, label: String(v) });
    return ticks;
  }

  function nameTicks(names) {
    return names.map((label, i) => ({ v: i + 1, label }));
  }

  // Powers of ten; with multiples 2 and 5 where there are few.
  function logTicks(from, to, pixels) {
    const decades = Math.log10(to / from), ticks = [];
    if (decades < 0.7) return null;
    const room = Math.max(2, pixels / 55), step = Math.max(1, Math.ceil(decades / room));
    for (let p = Math.floor(Math.log10(from)); p <= Math.log10(to); ++p)
      for (const factor of decades < 0.5 * room ? [1, 2, 5] : [1]) {
        const v = factor * Math.pow(10, p);
        if (v >= from && v <= to && (factor !== 1 || p % step === 0)) ticks.push({ v, label: rounded(v, 3) });
      }
    return ticks.length > 1 ? ticks : null;
  }

  const formatted = (value) => rounded(value, 4);

  function tickerOf(log, label, names) {
    return (from, to, pixels, options, dygraph, values) => {
      if (names.length) return nameTicks(names);
      if (label.includes("\u00b0")) return circleTicks(from, to, pixels);
      return (log && logTicks(from, to, pixels)) || Dygraph.numericTicks(from, to, pixels, options, dygraph, values);
    };
  }

  // On a touch screen one finger scrolls the page and two fingers zoom the plot.
  function interaction(reset) {
    const usual = Dygraph.defaultInteractionModel;
    const byTwo = (action) => (event, g, context) => { if (event.touches.length > 1) action(event, g, context); };
    return Object.assign({}, usual, { touchstart: byTwo(usual.touchstart), touchmove: byTwo(usual.touchmove), dblclick: reset });
  }

  // A line with many points per pixel is drawn by its range in each column of pixels. It looks the same and
  // is much faster to paint.
  function denseLine({ drawingContext, points }) {
    let column = null, drawn = false;
    const lineTo = (x, y) => {
      if (drawn) drawingContext.lineTo(x, y);
      else drawingContext.moveTo(x, y);
      drawn = true;
    };
    const flush = () => {
      if (column) for (const y of [column.first, column.least, column.most, column.last]) lineTo(column.x, y);
      column = null;
    };
    drawingContext.beginPath();
    for (const { canvasx, canvasy, yval } of points) {
      if (yval === null) continue;  // point of another curve
      const x = Math.round(2 * canvasx) / 2;
      if (!Number.isFinite(canvasy)) {
        flush();
        drawn = false;
      } else if (column && column.x === x) {
        column.least = Math.min(column.least, canvasy);
        column.most = Math.max(column.most, canvasy);
        column.last = canvasy;
      } else {
        flush();
        column = { x, first: canvasy, least: canvasy, most: canvasy, last: canvasy };
      }
    }
    flush();
    drawingContext.stroke();
  }

  // Dashes of a dense line would not be visible.
  function lineOf(dashes) {
    return (event) => {
      if (event.points.length > 4 * event.plotArea.w) return denseLine(event);
      event.drawingContext.save();
      event.drawingContext.setLineDash(dashes);
      Dygraph.Plotters.linePlotter(event);
      event.drawingContext.restore();
    };
  }
  const plotters = { line: lineOf([]), dashed: lineOf([7, 4]) };

  class Plot {
    constructor(place, figure, panel, mates) {
      this.panel = panel;
      this.mates = mates;
      this.curves = panel.curves.filter((curve) => numbers(curve.x).length > 0);
      this.labels = this.curves.map((curve, c) => "curve " + (c + 1));
      this.extent = extentOf(this.curves, panel);
      this.start = { dateWindow: panel.x_range || null, valueRange: panel.y_range || this.nameRange() };
      this.build(place, figure);
    }

    nameRange() {
      const n = (this.panel.y_names || []).length;
      return n ? [0.4, n + 0.6] : null;
    }

    build(place, figure) {
      const { panel } = this;
      if (panel.title) place.append(element("h4", {}, panel.title));
      const legend = element("div", { class: "legend" });
      place.append(element("div", { class: "plot-head" }, element("span", { class: "upwards" }, panel.y_label), legend));
      const names = (panel.y_names || []).length;
      this.box = element("div", {
        class: "plot" + (names ? " named" : figure.panels.length > 1 ? " low" : ""), tabindex: "0", role: "group",
        "aria-label": "Plot " + [figure.title, panel.title].filter(Boolean).join(", ") + ": " + panel.y_label +
          " against " + panel.x_label + ". Plus and minus keys zoom, arrow keys move, 0 shows everything."
      });
      if (names) this.box.style.height = 3.5 + 1.6 * names + "rem";
      this.readout = element("span", { class: "readout" });
      place.append(this.box, element("div", { class: "plot-foot" }, this.readout, element("span", { class: "across" }, panel.x_label)));
      this.legend(legend);
      this.box.addEventListener("keydown", (event) => this.key(event));
    }

    legend(place) {
      this.swatches = this.curves.map((curve, c) => {
        if (!curve.label) return null;
        const swatch = element("span", { class: "swatch" });
        const button = element("button", { type: "button", "aria-pressed": "true" }, swatch, curve.label);
        button.addEventListener("click", () => {
          const shown = button.getAttribute("aria-pressed") !== "true";
          button.setAttribute("aria-pressed", String(shown));
          this.g.setVisibility(c, shown);
        });
        place.append(button);
        return swatch;
      });
    }

    draw() {
      const { panel } = this, names = panel.y_names || [];
      const bands = this.curves.map((curve) => curve.style === "band"), bars = bands.includes(true);
      const made = this.curves.map((curve) => pointsOf(curve, panel, bars));
      const rows = rowsOf(made.map((m) => m.points), bands);
      if (!rows.length) {
        this.readout.textContent = "No data: these axes can show none of the values.";
        return;
      }
      const series = {};
      this.curves.forEach((curve, c) => { series[this.labels[c]] = Plot.style(curve, made[c].scattered); });
      const longest = Math.max(0, ...names.map((name) => name.length));
      this.g = new Dygraph(this.box, rows, Object.assign({
        labels: ["x"].concat(this.labels), series, customBars: bars, connectSeparatedPoints: true, legend: "never",
        logscale: panel.log_y, xRangePad: panel.log_x ? 0 : 6, yRangePad: 6, fillAlpha: 0.22, highlightCircleSize: 3,
        axisLabelFontSize: 12, rightGap: 8, interactionModel: interaction(() => this.reset()),
        showRangeSelector: !panel.log_x && rows.length > 1500 && this.isLast(), rangeSelectorHeight: 26,
        axes: {
          x: { logscale: panel.log_x, ticker: tickerOf(panel.log_x, panel.x_label, []), axisLabelFormatter: formatted, pixelsPerLabel: 60 },
          y: { ticker: tickerOf(panel.log_y, panel.y_label, names), axisLabelFormatter: formatted, pixelsPerLabel: 24,
               axisLabelWidth: names.length ? Math.min(0.42 * this.box.clientWidth, 7 * longest + 8) : 58 }
        },
        highlightCallback: (event, x, points) => this.tell(x, points),
        unhighlightCallback: () => { this.readout.textContent = ""; },
        drawCallback: (g, first) => { if (!first) this.lead(); }
      }, this.start, this.colours()));
      this.colourSwatches();
    }

    static style(curve, scattered) {
      if (curve.style === "points" || scattered) return { drawPoints: true, strokeWidth: 0, pointSize: 2.2 };
      if (curve.style === "band") return { strokeWidth: 0, highlightCircleSize: 0 };
      return { strokeWidth: 1.6, plotter: plotters[curve.style] };
    }

    colours() {
      return {
        colors: this.curves.map((curve) => curveColour(curve.colour)), gridLineColor: paint("--line"), axisLineColor: paint("--quiet"),
        rangeSelectorPlotStrokeColor: paint("--quiet"), rangeSelectorPlotFillColor: paint("--line"),
        rangeSelectorPlotFillGradientColor: paint("--surface"), rangeSelectorForegroundStrokeColor: paint("--quiet")
      };
    }

    colourSwatches() {
      this.curves.forEach((curve, c) => {
        if (!this.swatches[c]) return;
        const colour = curveColour(curve.colour);
        this.swatches[c].style.background = curve.style === "band" ? colour.replace("rgb(", "rgba(").replace(")", ",.3)")
          : curve.style === "dashed" ? "repeating-linear-gradient(90deg," + colour + " 0 6px,transparent 6px 9px) center/100% 3px no-repeat"
          : curve.style === "points" ? "radial-gradient(circle," + colour + " 3px,transparent 3.5px)"
          : "linear-gradient(" + colour + "," + colour + ") center/100% 3px no-repeat";
      });
    }

    colour() {
      if (!this.g) return;
      this.g.updateOptions(this.colours());
      this.colourSwatches();
    }

    tell(x, points) {
      const values = points.filter((p) => Number.isFinite(p.yval)).map((p) => {
        const curve = this.curves[this.labels.indexOf(p.name)];
        const names = this.panel.y_names || [];
        return (curve.label ? curve.label + " " : "") + (names[p.yval - 1] || rounded(p.yval, 4));
      });
      this.readout.textContent = "at " + rounded(x, 5) + (values.length ? ": " + values.join(", ") : "");
    }

    // The last of the panels with the same axis has the range selector.
    isLast() {
      return !this.mates.slice(this.mates.indexOf(this) + 1).some((mate) => this.shares(mate));
    }

    // Panels with the same axis always show the same range.
    lead() {
      if (this.following) return;
      for (const mate of this.mates) {
        if (mate === this || !mate.g || !this.shares(mate)) continue;
        mate.following = true;
        mate.g.updateOptions({ dateWindow: this.g.xAxisRange() });
        mate.following = false;
      }
    }

    shares(mate) {
      const [a, b] = this.extent, [c, d] = mate.extent;
      const near = (u, v) => Math.abs(u - v) <= 0.1 * Math.min(b - a, d - c);
      return mate.panel.x_label === this.panel.x_label && mate.panel.log_x === this.panel.log_x && near(a, c) && near(b, d);
    }

    // Changes the visible range: factor times as long about its middle, moved by a share of its length.
    show(factor, move) {
      const there = this.panel.log_x ? Math.log : (v) => v, back = this.panel.log_x ? Math.exp : (v) => v;
      const [from, to] = this.g.xAxisRange().map(there), [least, most] = this.extent.map(there);
      const half = 0.5 * Math.min(factor * (to - from), most - least);
      const centre = Math.min(most - half, Math.max(least + half, 0.5 * (from + to) + move * (to - from)));
      this.g.updateOptions({ dateWindow: [back(centre - half), back(centre + half)] });
    }

    reset() {
      for (const plot of this.mates) {
        if (!plot.g || (plot !== this && !this.shares(plot))) continue;
        plot.following = true;
        plot.g.updateOptions(plot.start);
        plot.following = false;
      }
    }

    key(event) {
      if (!this.g || event.ctrlKey || event.altKey || event.metaKey) return;
      const action = { "+": [0.5, 0], "=": [0.5, 0], "-": [2, 0], ArrowLeft: [1, -0.2], ArrowRight: [1, 0.2] }[event.key];
      if (action) this.show(...action);
      else if (event.key === "0") this.reset();
      else return;
      event.preventDefault();
    }
  }

  function zoomButtons(made) {
    const all = (action) => () => {
      const done = [];
      for (const plot of made) {
        if (!plot.g || done.some((other) => other.shares(plot))) continue;
        done.push(plot);
        action(plot);
      }
    };
    const button = (text, label, action) => {
      const b = element("button", { type: "button", "aria-label": label }, text);
      b.addEventListener("click", all(action));
      return b;
    };
    return element("span", { class: "zoom", role: "group", "aria-label": "Visible range of the axis" },
      button("+", "Zoom in", (plot) => plot.show(0.5, 0)), button("\u2212", "Zoom out", (plot) => plot.show(2, 0)),
      button("\u2190", "Move left", (plot) => plot.show(1, -0.2)), button("\u2192", "Move right", (plot) => plot.show(1, 0.2)),
      button("All", "Show all", (plot) => plot.reset()));
  }

  function drawFigure(place) {
    const figure = data.figures[Number(place.dataset.figure)], made = [];
    for (const panel of figure.panels) made.push(new Plot(place.querySelector(".plots"), figure, panel, made));
    for (const plot of made) plot.draw();
    plots.push(...made);
    place.querySelector(".tools").prepend(zoomButtons(made));
  }

  // ---- Printing. Plots are scaled down and not redrawn, because a resized canvas is printed empty.
  function print(begins) {
    const paper_px = 660;
    printing = begins;
    for (const plot of plots) plot.box.style.zoom = begins ? Math.min(1, paper_px / plot.box.clientWidth) : "";
    applyTheme();
  }
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));

  // ---- Draws one figure at a time, so that the page stays responsive
  const waiting = [...document.querySelectorAll("figure[data-figure], figure[data-view]")];
  function next() {
    const place = waiting.shift();
    if (!place) {
      root.dataset.ready = String(Math.round(performance.now()));
      return;
    }
    if (place.dataset.figure !== undefined) drawFigure(place);
    else views.push(makeView(place, data.views[Number(place.dataset.view)], { numbers, exact, element, rounded, paint }));
    setTimeout(next);
  }
  applyTheme();
  next();
  window.vibrissaReport = { data, plots, views, csvOf, exact, rounded };
})();
