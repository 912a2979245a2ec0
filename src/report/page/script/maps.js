// The maps: a slice through the workspace, and the values under a cross.

const svgElement = (name, attributes, text) => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) {
    element.setAttribute(key, value);
  }
  if (text !== undefined) {
    element.textContent = text;
  }
  return element;
};

const startMaps = (data) => {
  const { machine, marks } = data;
  const svgs = [...document.querySelectorAll("svg[data-map]")];
  if (!machine || svgs.length !== 3) {
    return;
  }
  const NODES = 49;
  const scales = machine.scale.maps;
  const slider = document.getElementById("slice");
  const readout = document.getElementById("map-readout");
  const invitation = readout.textContent;
  const STEPS = Number(slider.max);
  const frames = svgs.map((svg) => {
    const [x, y, w, h] = ["x", "y", "w", "h"].map((key) => Number(svg.dataset[key]));
    return { x, y, w, h };
  });
  const state = { part: machine.slice, cross: null, waiting: false };
  const height = () => machine.least[2] + machine.width[2] * state.part;
  const grid = (k) => Array.from({ length: NODES }, (_, i) =>
    machine.least[k] + (machine.width[k] * i) / (NODES - 1));
  const [xs, ys] = [grid(0), grid(1)];

  const pathData = (paths, frame, closed) =>
    paths
      .map((path) => {
        const points = path.map(([x, y]) => onMap(frame, x, y).map((c) => c.toFixed(1)).join(" "));
        return `M${points.join("L")}${closed ? "Z" : ""}`;
      })
      .join("");
  const onMap = (frame, x, y) => {
    const part = (k, v) => (machine.width[k] > 0 ? (v - machine.least[k]) / machine.width[k] : 0.5);
    return [frame.x + part(0, x) * frame.w, frame.y + (1 - part(1, y)) * frame.h];
  };
  const lengthOf = (line) =>
    line.slice(1).reduce((sum, p, i) => sum + Math.hypot(p[0] - line[i][0], p[1] - line[i][1]), 0);

  const label = (group, set, frame, level, k, taken) => {
    const lines = set.lines.map((line) => line.map(([x, y]) => onMap(frame, x, y)));
    const longest = lines.reduce((best, line) => (lengthOf(line) > lengthOf(best) ? line : best), []);
    const total = lengthOf(longest);
    if (total < 34) {
      return;
    }
    let rest = total * [0.5, 0.38, 0.62][k % 3];
    let at = 1;
    while (at < longest.length - 1) {
      const piece = Math.hypot(longest[at][0] - longest[at - 1][0], longest[at][1] - longest[at - 1][1]);
      if (piece >= rest) {
        break;
      }
      rest -= piece;
      at += 1;
    }
    const [x, y] = [longest[at][0], longest[at][1] + 3.5];
    if (taken.some((other) => Math.hypot(other[0] - x, other[1] - y) < 19)) {
      return;
    }
    taken.push([x, y]);
    const text = shown(level, 6);
    group.append(svgElement("text", { class: "level-label", x: x.toFixed(1), y: y.toFixed(1) }, text));
  };

  const drawMap = (i, values, reach) => {
    const [svg, frame] = [svgs[i], frames[i]];
    const { levels, colours, dark } = scales[i];
    const field = svg.querySelector(".field");
    const name = svg.classList[1];
    const { x, y, w, h } = frame;
    const ground = svgElement("rect", { x, y, width: w, height: h, fill: colours[0] });
    const [bands, lines] = [[], []];
    const texts = svgElement("g", {});
    const here = marks.filter((mark) => Math.abs(mark.at[2] - height()) <= 1e-6 * machine.width[2]);
    const taken = here.map((mark) => onMap(frame, mark.at[0], mark.at[1]));
    levels.forEach((level, k) => {
      const set = levelSet(xs, ys, values, level);
      bands.push(svgElement("path", { class: "band", fill: colours[k + 1], d: pathData(set.area, frame, true) }));
      const className = dark[k] ? "level on-dark" : "level";
      lines.push(svgElement("path", { class: className, d: pathData(set.lines, frame, false) }));
      label(texts, set, frame, level, k, taken);
    });
    const hatched = { class: "unreachable", fill: `url(#${name}-hatch)`, d: pathData(reach.area, frame, true) };
    field.replaceChildren(ground, ...bands, ...lines, svgElement("path", hatched), texts);
    svg.querySelectorAll(".mark, .mark-label").forEach((mark) => mark.remove());
    const crosshair = svg.querySelector(".crosshair");
    for (const mark of here) {
      const [cx, cy] = onMap(frame, mark.at[0], mark.at[1]);
      const end = 2 * (cx - frame.x) > frame.w;
      const place = {
        class: `mark-label ${end ? "end" : "start"}`,
        x: cx + (end ? -7 : 7),
        y: cy + (cy < frame.y + 18 ? 15 : -6),
      };
      crosshair.before(svgElement("circle", { class: "mark", cx, cy, r: 3.5 }));
      crosshair.before(svgElement("text", place, mark.name));
    }
  };

  const drawSlice = () => {
    const z = height();
    const fields = [[], [], [], []];
    for (const y of ys) {
      for (const x of xs) {
        const { psi, clearance } = factorsAt(machine.legs, [x, y, z]);
        [0, 1, 2].forEach((i) => fields[i].push(psi ? psi[i] : NaN));
        fields[3].push(-clearance);
      }
    }
    const reach = levelSet(xs, ys, fields[3], 0);
    svgs.forEach((_, i) => drawMap(i, fields[i], reach));
    document.getElementById("slice-value").textContent = `z = ${shown(z, 6)}`;
    document.querySelectorAll("#maps figcaption.static").forEach((caption) => {
      caption.textContent = `z = ${shown(z, 6)}`;
    });
    svgs.forEach((svg, i) => {
      const title = `Lines of equal psi_${i + 1} at z = ${shown(z, 6)}; arrow keys move a cross and read values`;
      svg.setAttribute("aria-label", title);
    });
  };

  const drawCross = () => {
    svgs.forEach((svg, i) => {
      const group = svg.querySelector(".crosshair");
      if (!state.cross) {
        group.replaceChildren();
        return;
      }
      const { x, y, w, h } = frames[i];
      const [cx, cy] = [x + state.cross[0] * w, y + (1 - state.cross[1]) * h];
      group.replaceChildren(
        svgElement("line", { x1: x, y1: cy, x2: x + w, y2: cy }),
        svgElement("line", { x1: cx, y1: y, x2: cx, y2: y + h }),
      );
    });
    if (!state.cross) {
      readout.textContent = invitation;
      return;
    }
    const P = [0, 1].map((k) => machine.least[k] + machine.width[k] * state.cross[k]);
    P.push(height());
    const { psi } = factorsAt(machine.legs, P);
    const at = `P = (${P.map((x) => shown(x, 6)).join(", ")}): `;
    const away = machine.cylinder && Math.hypot(2 * state.cross[0] - 1, 2 * state.cross[1] - 1) > 1;
    const values = psi
      ? psi.map((x, i) => `\u03c8${"\u2081\u2082\u2083"[i]} = ${shown(x, 10)}`).join(", ")
      : "out of reach";
    readout.textContent = at + values + (away ? " (outside the workspace)" : "");
  };

  const drawSoon = () => {
    if (!state.waiting) {
      state.waiting = true;
      requestAnimationFrame(() => {
        state.waiting = false;
        drawSlice();
        drawCross();
      });
    }
  };
  const moveSlice = (part) => {
    state.part = Math.min(Math.max(part, 0), 1);
    slider.value = Math.round(state.part * STEPS);
    drawSoon();
  };

  slider.addEventListener("input", () => moveSlice(Number(slider.value) / STEPS));
  document.getElementById("slice-reset").addEventListener("click", () => moveSlice(machine.slice));
  svgs.forEach((svg, i) => {
    svg.setAttribute("tabindex", "0");
    const { x, y, w, h } = frames[i];
    const point = (event) => {
      const box = svg.getBoundingClientRect();
      const view = svg.viewBox.baseVal;
      const px = ((event.clientX - box.left) / box.width) * view.width;
      const py = ((event.clientY - box.top) / box.height) * view.height;
      const cross = [(px - x) / w, 1 - (py - y) / h];
      state.cross = cross.every((c) => c >= 0 && c <= 1) ? cross : null;
      drawCross();
    };
    svg.addEventListener("pointermove", point);
    svg.addEventListener("pointerdown", point);
    svg.addEventListener("keydown", (event) => {
      const step = event.shiftKey ? 0.1 : 0.01;
      const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] };
      const slices = { PageUp: 0.05, PageDown: -0.05 };
      if (event.key in moves) {
        const from = state.cross || [0.5, 0.5];
        const to = state.cross ? moves[event.key] : [0, 0];
        state.cross = from.map((c, k) => Math.min(Math.max(c + to[k], 0), 1));
        drawCross();
      } else if (event.key in slices) {
        moveSlice(state.part + slices[event.key]);
      } else {
        return;
      }
      event.preventDefault();
    });
  });
  slider.value = Math.round(state.part * STEPS);
  drawSlice();
};
