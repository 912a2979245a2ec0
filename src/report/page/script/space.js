// The subdivision in space. What is left of the root after the cut is a box, so that only the
// leaves on its three faces towards the viewer are seen, and nothing has to be sorted. Alone, the
// deepest boxes are drawn from back to front.

const startSpace = (data) => {
  const canvas = document.getElementById("space");
  if (!canvas || !canvas.getContext) {
    return;
  }
  const MOST = 4000;
  const context = canvas.getContext("2d");
  const control = (id) => document.getElementById(id);
  const readout = control("space-readout");
  const all = data.trees.map((tree) =>
    leavesOf(tree, data.rules, data.discharges, data.obligations.length));
  const HOME = { azimuth: 32, elevation: 24, zoom: 1 };
  const state = { tree: 0, axis: 0, cut: 1, deep: 0, colour: 0, ...HOME };
  const tree = () => data.trees[state.tree];
  const leaves = () => all[state.tree];
  const patterns = new Map();

  const option = (select, value, text) => {
    const element = document.createElement("option");
    element.value = value;
    element.textContent = text;
    select.append(element);
  };

  const patternOf = (rule) => {
    if (!patterns.has(rule)) {
      const { colour, pattern } = data.rules[rule];
      const tile = document.createElement("canvas");
      tile.width = tile.height = 16;
      const pen = tile.getContext("2d");
      pen.scale(2, 2);
      pen.fillStyle = colour;
      pen.fillRect(0, 0, 8, 8);
      pen.strokeStyle = "rgba(27, 35, 48, 0.55)";
      pen.stroke(new Path2D(data.patterns[pattern]));
      patterns.set(rule, context.createPattern(tile, "repeat"));
    }
    return patterns.get(rule);
  };
  const depths = () => {
    const { depth, count } = leaves();
    let [least, most] = [Infinity, 0];
    for (let i = 0; i < count; i += 1) {
      least = Math.min(least, depth[i]);
      most = Math.max(most, depth[i]);
    }
    return count > 0 ? [least, most] : [0, 0];
  };
  // The style of a leaf, as a key and the fill for it.
  const byDepth = () => state.colour === data.obligations.length;
  const keyOf = (i) =>
    byDepth() ? leaves().depth[i] : leaves().by[data.obligations.length * i + state.colour];
  const fillOf = (key, range) => {
    if (byDepth()) {
      return shade(key, range);
    }
    return key < 0 ? styleOf("--paper") : patternOf(key);
  };

  const projection = () => viewOf(state, tree().shape, canvas.width, canvas.height);
  // Where a part of an axis is: of angles, of which the tree has tangents of halves, in degrees.
  const placeOf = (k, u) => {
    const { least, width, angles } = tree();
    const x = least[k] + u * width[k];
    return k >= angles ? (360 / Math.PI) * Math.atan(x) : x;
  };
  const upper = () => [0, 1, 2].map((k) => (k === state.axis ? state.cut : 1));
  const SHADES = [0.1, 0.18, 0];

  // Calls with every leaf on the face u_axis = end of what the cut leaves, clipped.
  const onFace = (axis, end, limit, call) => {
    const { low, high, count } = leaves();
    const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
    for (let i = 0; i < count; i += 1) {
      const [from, to] = [low[3 * i + axis], high[3 * i + axis]];
      const touches = end > 0 ? from < end && end <= to : from === 0;
      if (touches && low[3 * i + b] < limit[b] && low[3 * i + c] < limit[c]) {
        const least = [low[3 * i], low[3 * i + 1], low[3 * i + 2]];
        const most = [0, 1, 2].map((k) => Math.min(high[3 * i + k], limit[k]));
        call(i, least, most);
      }
    }
  };

  const drawSolid = ({ at, toward }, range) => {
    const limit = upper();
    for (let axis = 0; axis < 3; axis += 1) {
      const end = toward[axis] > 0 ? limit[axis] : 0;
      const fills = new Map();
      const specks = new Set();
      context.strokeStyle = "rgba(27, 35, 48, 0.75)";
      context.lineWidth = 0.8;
      onFace(axis, end, limit, (i, low, high) => {
        const key = keyOf(i);
        if (!fills.has(key)) {
          fills.set(key, fillOf(key, range));
        }
        context.fillStyle = fills.get(key);
        const [o, p, m, q] = corners(axis, end, low, high).map(at);
        const size = Math.max(Math.abs(m[0] - o[0]), Math.abs(m[1] - o[1]), Math.abs(p[0] - q[0]), Math.abs(p[1] - q[1]));
        if (size < 1.5) {
          // One of all boxes that are too small to be told apart.
          const speck = Math.round(o[0]) * 65536 + Math.round(o[1]);
          if (!specks.has(speck)) {
            specks.add(speck);
            context.fillRect(Math.round(o[0]), Math.round(o[1]), 1.5, 1.5);
          }
          return;
        }
        context.beginPath();
        trace(context, [o, p, m, q]);
        context.fill();
        if (size > 4) {
          context.stroke();
        }
      });
      const face = new Path2D();
      trace(face, corners(axis, end, [0, 0, 0], limit).map(at));
      context.fillStyle = `rgba(0, 0, 0, ${leaves().count > 0 ? SHADES[axis] : 0})`;
      context.fill(face);
    }
  };

  // The boxes of at least the chosen depth that the cut leaves, from back to front.
  const deepest = (toward) => {
    const { low, high, depth, count } = leaves();
    let chosen = [];
    for (let i = 0; i < count; i += 1) {
      if (depth[i] >= state.deep && low[3 * i + state.axis] < state.cut) {
        chosen.push(i);
      }
    }
    const total = chosen.length;
    if (total > MOST) {
      chosen.sort((i, j) => depth[j] - depth[i] || i - j);
      chosen = chosen.slice(0, MOST);
    }
    const shape = tree().shape;
    const near = (i) =>
      [0, 1, 2].reduce((sum, k) => sum + toward[k] * shape[k] * (low[3 * i + k] + high[3 * i + k]), 0);
    const keys = new Map(chosen.map((i) => [i, near(i)]));
    chosen.sort((i, j) => keys.get(i) - keys.get(j) || i - j);
    return { chosen, total };
  };
  const boxOf = (i) => {
    const { low, high } = leaves();
    return [[...low.subarray(3 * i, 3 * i + 3)], [...high.subarray(3 * i, 3 * i + 3)]];
  };
  const drawDeepest = ({ at, toward }, range) => {
    const { chosen, total } = deepest(toward);
    context.strokeStyle = "rgba(27, 35, 48, 0.75)";
    context.lineWidth = 0.7;
    for (const i of chosen) {
      const [low, high] = boxOf(i);
      for (let axis = 0; axis < 3; axis += 1) {
        const end = toward[axis] > 0 ? high[axis] : low[axis];
        const path = new Path2D();
        trace(path, corners(axis, end, low, high).map(at));
        context.fillStyle = fillOf(keyOf(i), range);
        context.globalAlpha = 0.85;
        context.fill(path);
        context.globalAlpha = 1;
        context.stroke(path);
      }
    }
    return total;
  };

  const drawFrame = ({ at, toward }) => {
    const far = toward.map((d) => (d > 0 ? 0 : 1));
    const bare = leaves().count === 0 || alone() || state.cut < 1;
    context.strokeStyle = styleOf("--accent");
    for (let a = 0; a < 8; a += 1) {
      for (let k = 0; k < 3; k += 1) {
        if ((a >> k) & 1) {
          continue;
        }
        const from = [0, 1, 2].map((j) => (a >> j) & 1);
        const to = from.slice();
        to[k] = 1;
        const hidden = [0, 1, 2].every((j) => j === k || from[j] === far[j]);
        if (hidden && !bare) {
          continue;
        }
        context.lineWidth = hidden ? 1 : 1.6;
        context.setLineDash(hidden || state.cut < 1 ? [4, 5] : []);
        context.beginPath();
        context.moveTo(...at(from));
        context.lineTo(...at(to));
        context.stroke();
      }
    }
    context.setLineDash([]);
    drawNames(context, tree().axes, at, styleOf("--ink"), (k, u) => shown(placeOf(k, u), 4));
    drawMarks(at, toward);
  };
  const drawMarks = (at, toward) => {
    if (!data.marksInTree) {
      return;
    }
    const { least, width } = tree();
    context.textAlign = "left";
    context.font = `600 ${Math.round(canvas.width / 66)}px sans-serif`;
    for (const mark of data.marks) {
      const u = mark.at.map((x, k) => (width[k] > 0 ? (x - least[k]) / width[k] : 0.5));
      const [x, y] = at(u);
      const limit = upper();
      const behind = leaves().count > 0 && !alone() &&
        [0, 1, 2].every((k) => Math.abs(u[k] - (toward[k] > 0 ? limit[k] : 0)) > 1e-9 && u[k] <= limit[k]);
      context.beginPath();
      context.arc(x, y, canvas.width / 150, 0, 2 * Math.PI);
      context.fillStyle = styleOf("--strong");
      context.strokeStyle = styleOf(behind ? "--strong" : "--paper");
      context.lineWidth = behind ? 2 : 3;
      context.setLineDash(behind ? [3, 3] : []);
      context.stroke();
      context.setLineDash([]);
      if (behind) {
        continue;
      }
      context.fill();
      context.strokeText(mark.name, x + 10, y - 10);
      context.fillText(mark.name, x + 10, y - 10);
    }
  };
  const drawKey = (range) => {
    if (!byDepth() || leaves().count === 0) {
      return;
    }
    const [least, most] = range;
    const steps = Math.min(most - least + 1, 12);
    const size = canvas.width / 50;
    context.textAlign = "center";
    context.textBaseline = "top";
    context.font = `${Math.round(canvas.width / 75)}px sans-serif`;
    for (let s = 0; s < steps; s += 1) {
      const depth = steps > 1 ? Math.round(least + (s * (most - least)) / (steps - 1)) : least;
      const [x, y] = [size + s * size * 1.6, canvas.height - 2.6 * size];
      context.fillStyle = shade(depth, range);
      context.fillRect(x, y, size * 1.6, size);
      context.fillStyle = styleOf("--ink");
      context.fillText(String(depth), x + 0.8 * size, y + size + 4);
    }
  };

  const alone = () => state.deep > depths()[0];
  const draw = () => {
    context.clearRect(0, 0, canvas.width, canvas.height);
    const [view, range] = [projection(), depths()];
    let deep = "all boxes";
    if (alone()) {
      const total = drawDeepest(view, range);
      deep = `${state.deep}: ${total} ${total === 1 ? "box" : "boxes"}`;
      deep += total > MOST ? `, the deepest ${MOST} drawn` : "";
    } else {
      drawSolid(view, range);
    }
    drawFrame(view);
    drawKey(range);
    const place = placeOf(state.axis, state.cut);
    control("cut-value").textContent = `${tree().axes[state.axis]} \u2264 ${shown(place, 5)}`;
    control("deep-value").textContent = deep;
    canvas.dataset.view = `${state.azimuth.toFixed(1)} ${state.elevation.toFixed(1)} ${state.zoom.toFixed(2)}`;
  };
  const drawSoon = soon(draw);

  // The leaf that is seen at a point of the canvas, or -1.
  const leafAt = (x, y) => {
    const { at, toward } = projection();
    const limit = upper();
    const inside = (axis, end, low, high) => covers([x, y], corners(axis, end, low, high).map(at));
    if (alone()) {
      const { chosen } = deepest(toward);
      return chosen.reverse().find((i) => {
        const [low, high] = boxOf(i);
        return [0, 1, 2].some((axis) => inside(axis, toward[axis] > 0 ? high[axis] : low[axis], low, high));
      }) ?? -1;
    }
    let found = -1;
    for (let axis = 0; axis < 3 && found < 0; axis += 1) {
      const end = toward[axis] > 0 ? limit[axis] : 0;
      onFace(axis, end, limit, (i, low, high) => {
        if (found < 0 && inside(axis, end, low, high)) {
          found = i;
        }
      });
    }
    return found;
  };
  const describe = (i) => {
    if (i < 0) {
      const { count } = leaves();
      readout.textContent = count > 0 ? `${count} boxes; point at one to read it.` : "No boxes: one point refutes the claim.";
      return;
    }
    const [low, high] = boxOf(i);
    const edges = tree().axes.map((name, k) => {
      const [a, b] = [low, high].map((u) => shown(placeOf(k, u[k]), 7));
      return `${name} from ${a} to ${b}`;
    });
    const n = data.obligations.length;
    const rules = data.obligations
      .map((name, o) => [name, leaves().by[n * i + o]])
      .filter(([, rule]) => rule >= 0)
      .map(([name, rule]) => `${name} by ${data.rules[rule].name}`);
    readout.textContent = `Box: ${edges.join(", ")}; depth ${leaves().depth[i]}; ends rounded. ${rules.join(", ")}.`;
  };

  const chooseTree = (t) => {
    state.tree = t;
    const [least, most] = depths();
    const deep = control("deep");
    [deep.min, deep.max, deep.value] = [least, most, least];
    state.deep = least;
    const axis = control("cut-axis");
    axis.replaceChildren();
    tree().axes.forEach((name, k) => option(axis, k, name));
    axis.value = state.axis;
    describe(-1);
    drawSoon();
  };
  const moveCut = (cut) => {
    state.cut = Math.min(Math.max(cut, 0.001), 1);
    control("cut").value = Math.round(1000 * state.cut);
    drawSoon();
  };

  data.trees.forEach((one, t) => option(control("tree"), t, one.name));
  control("tree-label").hidden = data.trees.length < 2;
  data.obligations.forEach((name, o) => {
    const used = all.some(({ by, count }) => {
      for (let i = 0; i < count; i += 1) {
        const rule = by[data.obligations.length * i + o];
        if (rule >= 0 && data.discharges[rule] === o) {
          return true;
        }
      }
      return false;
    });
    if (used) {
      option(control("obligation"), o, `rule for ${name}`);
    }
  });
  option(control("obligation"), data.obligations.length, "depth");
  state.colour = data.trees[0].filledBy;
  control("obligation").value = state.colour;
  if (all.every(({ count }) => count === 0)) {
    ["obligation", "cut-axis", "cut", "deep"].forEach((id) => {
      control(id).parentElement.hidden = true;
    });
    ["cut-value", "deep-value"].forEach((id) => {
      control(id).hidden = true;
    });
  }
  control("tree").addEventListener("change", (event) => chooseTree(Number(event.target.value)));
  control("obligation").addEventListener("change", (event) => {
    state.colour = Number(event.target.value);
    drawSoon();
  });
  control("cut-axis").addEventListener("change", (event) => {
    state.axis = Number(event.target.value);
    drawSoon();
  });
  control("cut").addEventListener("input", (event) => moveCut(Number(event.target.value) / 1000));
  control("deep").addEventListener("input", (event) => {
    state.deep = Number(event.target.value);
    drawSoon();
  });
  control("view-reset").addEventListener("click", () => {
    Object.assign(state, HOME);
    moveCut(1);
    control("deep").value = depths()[0];
    state.deep = depths()[0];
  });
  startTurning(canvas, state, { drawSoon, moveCut, describe: (x, y) => describe(leafAt(x, y)) });
  chooseTree(0);
  return drawSoon;
};
