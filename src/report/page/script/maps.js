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

  // Names and levels are on no other: what each takes is a rectangle, its least and greatest corner.
  const about = (x, y, across, up) => [[x - across, y - up], [x + across, y + up]];
  const meet = (a, b) => [0, 1].every((k) => a[0][k] < b[1][k] && b[0][k] < a[1][k]);
  const isWithin = (own, { x, y, w, h }) =>
    own.every(([px, py]) => px >= x && px <= x + w && py >= y && py <= y + h) &&
    (!machine.cylinder || own.every(([px]) => own.every(([, py]) =>
      Math.hypot((2 * (px - x)) / w - 1, (2 * (py - y)) / h - 1) <= 1)));
  const along = (line, part) => {
    let rest = part * lengthOf(line);
    for (let i = 1; i < line.length; i += 1) {
      const [[ax, ay], [bx, by]] = [line[i - 1], line[i]];
      const piece = Math.hypot(bx - ax, by - ay);
      if (piece >= rest && piece > 0) {
        return [ax + (rest / piece) * (bx - ax), ay + (rest / piece) * (by - ay)];
      }
      rest -= piece;
    }
    return line[line.length >> 1];
  };
  const PARTS = [0.5, 0.38, 0.62, 0.26, 0.74, 0.14, 0.86, 0.06, 0.94];
  const label = (group, set, frame, level, k, taken) => {
    const lines = set.lines.map((line) => line.map(([x, y]) => onMap(frame, x, y)));
    const long = lines.filter((line) => lengthOf(line) >= 34).sort((a, b) => lengthOf(b) - lengthOf(a));
    const text = shown(level, 6);
    for (const line of long) {
      for (let i = 0; i < PARTS.length; i += 1) {
        const [x, y] = along(line, PARTS[(i + (k % 3)) % PARTS.length]);
        const own = about(x, y, 3.2 * text.length + 2, 7.5);
        if (isWithin(own, frame) && !taken.some((other) => meet(own, other))) {
          taken.push(own);
          const place = { class: "level-label", x: x.toFixed(1), y: (y + 3.5).toFixed(1) };
          group.append(svgElement("text", place, text));
          return;
        }
      }
    }
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
    const taken = [];
    const names = here.map((mark) => {
      const [cx, cy] = onMap(frame, mark.at[0], mark.at[1]);
      const end = 2 * (cx - frame.x) > frame.w;
      const [px, py] = [cx + (end ? -7 : 7), cy + (cy < frame.y + 18 ? 15 : -6)];
      const width = 7.7 * mark.name.length * (end ? -1 : 1);
      taken.push(about(cx, cy, 5, 5), about(px + width / 2, py - 4, Math.abs(width) / 2, 6));
      const place = { class: `mark-label ${end ? "end" : "start"}`, x: px, y: py };
      return [svgElement("circle", { class: "mark", cx, cy, r: 3.5 }), svgElement("text", place, mark.name)];
    });
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
    crosshair.before(...names.flat());
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
