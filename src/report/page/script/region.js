// The region of a paving in space. Its tree is walked from behind: of two halves, none hides a part
// of the one on the viewer's side. A cut takes away what is above it, and shows what it goes through.

// The nodes of a tree from its code: X, Y or Z for a split, # for an inner leaf, ? for an undecided
// one, a point for an outer one.
const regionOf = (code) => {
  let at = 0;
  const next = (low, high) => {
    const kind = code[at];
    at += 1;
    const axis = "XYZ".indexOf(kind);
    if (axis < 0) {
      return { kind, low, high, open: null };
    }
    const middle = (low[axis] + high[axis]) / 2;
    const [below, above] = [high.slice(), low.slice()];
    below[axis] = middle;
    above[axis] = middle;
    return { axis, middle, lower: next(low, below), upper: next(above, high) };
  };
  return next([0, 0, 0], [1, 1, 1]);
};

// Whether all that is next to a side of a leaf is inner.
const isCovered = (node, leaf, axis, upward) => {
  if (node.kind) {
    return node.kind === "#";
  }
  const end = upward ? leaf.high[axis] : leaf.low[axis];
  const up = node.middle < end || (node.middle === end && upward);
  const into = node.axis === axis
    ? [!up, up]
    : [leaf.low[node.axis] < node.middle, node.middle < leaf.high[node.axis]];
  return (!into[0] || isCovered(node.lower, leaf, axis, upward)) && (!into[1] || isCovered(node.upper, leaf, axis, upward));
};

// The decimals of so many places next to both ends of a part [low, high] of an edge, in the part.
// `ends` has the edge's ends as fractions p/q and r/s: not above them, then not below them. So the
// least end is rounded up from what is not below it, the greatest down from what is not above it. A
// fraction is rounded exactly; the parts of a tree are multiples of 2^-HALVINGS, or are rounded so, too.
const HALVINGS = 60;
const within = (ends, [low, high], places) => {
  const rounded = (fractions, u, upward) => {
    const [p, q, r, s] = fractions.map(BigInt);
    const whole = 1n << BigInt(HALVINGS);
    const part = BigInt((upward ? Math.ceil : Math.floor)(u * 2 ** HALVINGS));
    const top = (p * s * (whole - part) + r * q * part) * 10n ** BigInt(places);
    const bottom = q * s * whole;
    const below = top / bottom - (top % bottom < 0n ? 1n : 0n);
    return upward && below * bottom !== top ? below + 1n : below;
  };
  const text = (n) => {
    const digits = String(n < 0n ? -n : n).padStart(places + 1, "0");
    const decimal = `${digits.slice(0, -places)}.${digits.slice(-places)}`;
    return (n < 0n ? "-" : "") + decimal.replace(/\.?0+$/, "");
  };
  return [text(rounded(ends[1], low, true)), text(rounded(ends[0], high, false))];
};

const startRegion = (data) => {
  const canvas = document.getElementById("region-space");
  if (!canvas || !canvas.getContext) {
    return;
  }
  const context = canvas.getContext("2d");
  const control = (id) => document.getElementById(id);
  const readout = control("region-readout");
  const { code, least, width, shape, marks, axes } = data.region;
  const tree = regionOf(code);
  const HOME = { azimuth: 32, elevation: 24, zoom: 1 };
  const state = { axis: 0, cut: 1, ...HOME };
  const WALLS = ["#6fa8cf", "#8ec1e0", "#b9dcf0"];
  const SIDES = ["#d58a35", "#e6a352", "#f5c788"];
  const ON_CUT = { "#": "#74c69d", "?": "#6b7480" };

  // Which sides are seen at all: not those beside inner leaves only.
  const openSides = (leaf) => {
    leaf.open = leaf.open || [0, 1, 2].flatMap((axis) => [false, true].map((upward) => {
      const end = upward ? leaf.high[axis] : leaf.low[axis];
      return end === 0 || end === 1 || !isCovered(tree, leaf, axis, upward);
    }));
    return leaf.open;
  };

  // Calls with every face that is seen, from behind: its leaf, axis, end, least and greatest corner,
  // and whether it is on the cut.
  const eachFace = (toward, call) => {
    const visit = (node) => {
      if (!node.kind) {
        const onlyLower = node.axis === state.axis && node.middle >= state.cut;
        const order = toward[node.axis] > 0 ? [node.lower, node.upper] : [node.upper, node.lower];
        order.filter((half) => !onlyLower || half === node.lower).forEach(visit);
        return;
      }
      if (node.kind === ".") {
        return;
      }
      const high = node.high.slice();
      high[state.axis] = Math.min(high[state.axis], state.cut);
      for (let axis = 0; axis < 3; axis += 1) {
        const upward = toward[axis] > 0;
        const end = upward ? high[axis] : node.low[axis];
        const onCut = axis === state.axis && upward && state.cut < 1 && node.high[axis] >= state.cut;
        if (onCut || (node.kind === "#" && openSides(node)[2 * axis + Number(upward)])) {
          call(node, axis, end, node.low, high, onCut);
        }
      }
    };
    visit(tree);
  };
  const fillOf = (leaf, axis, end, onCut) => {
    if (onCut) {
      return ON_CUT[leaf.kind];
    }
    return (end === 0 || end === 1 ? SIDES : WALLS)[axis];
  };

  const draw = () => {
    const { at, toward } = viewOf(state, shape, canvas.width, canvas.height);
    context.clearRect(0, 0, canvas.width, canvas.height);
    drawEdges(at, toward, true);
    context.lineJoin = "round";
    let count = 0;
    eachFace(toward, (leaf, axis, end, low, high, onCut) => {
      const [o, p, m, q] = corners(axis, end, low, high).map(at);
      const side = ([x, y]) => Math.hypot(x - o[0], y - o[1]);
      context.beginPath();
      trace(context, [o, p, m, q]);
      context.fillStyle = fillOf(leaf, axis, end, onCut);
      context.fill();
      // Without a line of its own colour, the background would shine through between faces.
      context.strokeStyle = Math.min(side(p), side(q)) > 5 ? "rgba(27, 35, 48, 0.45)" : context.fillStyle;
      context.lineWidth = 0.7;
      context.stroke();
      count += 1;
    });
    drawEdges(at, toward, false);
    drawNames(context, axes, at, styleOf("--ink"), (k, u) => shown(least[k] + u * width[k], 4));
    drawPlaces(at);
    const place = least[state.axis] + state.cut * width[state.axis];
    control("region-cut-value").textContent = `${axes[state.axis]} \u2264 ${shown(place, 5)}`;
    canvas.dataset.view = `${state.azimuth.toFixed(1)} ${state.elevation.toFixed(1)} ${state.zoom.toFixed(2)}`;
    canvas.dataset.faces = count;
  };
  const drawSoon = soon(draw);

  // The edges of the box: those behind the region, or those before it.
  const drawEdges = (at, toward, behind) => {
    const far = toward.map((d) => (d > 0 ? 0 : 1));
    context.strokeStyle = styleOf("--accent");
    for (let a = 0; a < 8; a += 1) {
      for (let k = 0; k < 3; k += 1) {
        const from = [0, 1, 2].map((j) => (a >> j) & 1);
        const isBehind = [0, 1, 2].every((j) => j === k || from[j] === far[j]);
        if ((a >> k) & 1 || isBehind !== behind) {
          continue;
        }
        const to = from.slice();
        to[k] = 1;
        context.lineWidth = behind ? 1 : 1.3;
        context.setLineDash([4, 5]);
        context.beginPath();
        context.moveTo(...at(from));
        context.lineTo(...at(to));
        context.stroke();
      }
    }
    context.setLineDash([]);
  };
  const drawPlaces = (at) => {
    context.textAlign = "left";
    context.font = `600 ${Math.round(canvas.width / 66)}px sans-serif`;
    for (const mark of marks) {
      const u = mark.at.map((x, k) => (x - least[k]) / width[k]);
      if (u[state.axis] > state.cut) {
        continue;
      }
      const [x, y] = at(u);
      context.beginPath();
      context.arc(x, y, canvas.width / 150, 0, 2 * Math.PI);
      context.strokeStyle = styleOf("--strong");
      context.lineWidth = 2;
      context.setLineDash([3, 3]);
      context.stroke();
      context.setLineDash([]);
    }
  };

  const leafAt = (x, y) => {
    const { at, toward } = viewOf(state, shape, canvas.width, canvas.height);
    let found = null;
    eachFace(toward, (leaf, axis, end, low, high) => {
      if (covers([x, y], corners(axis, end, low, high).map(at))) {
        found = leaf;
      }
    });
    return found;
  };
  const describe = (x, y) => {
    const leaf = leafAt(x, y);
    if (!leaf) {
      const ring = marks.length > 0 ? " The dashed ring is the best conditioned point found." : "";
      readout.textContent = `Point at a box to read it.${ring}`;
      return;
    }
    // What is read is in the box: seven digits, or a thousandth of its edge where that is finer.
    const edges = axes.map((name, k) => {
      const [low, high] = [leaf.low[k], leaf.high[k]];
      const size = Math.max(Math.abs(least[k]), Math.abs(least[k] + width[k]));
      const unit = Math.min(size * 1e-6, (high - low) * width[k] * 1e-3);
      const places = Math.max(1, Math.ceil(-Math.log10(unit)));
      const [a, b] = within(data.ends[k], [low, high], places);
      return name ? `${name} from ${a} to ${b}` : "";
    }).filter((edge) => edge);
    const what = leaf.kind === "#" ? "Inner, all requirements hold" : "Undecided";
    readout.textContent = `${what}: ${edges.join(", ")}.`;
  };
  const moveCut = (cut) => {
    state.cut = Math.round(1000 * Math.min(Math.max(cut, 0.001), 1)) / 1000;
    control("region-cut").value = 1000 * state.cut;
    drawSoon();
  };

  control("region-axis").addEventListener("change", (event) => {
    state.axis = Number(event.target.value);
    drawSoon();
  });
  control("region-cut").addEventListener("input", (event) => moveCut(Number(event.target.value) / 1000));
  control("region-reset").addEventListener("click", () => {
    Object.assign(state, HOME);
    moveCut(1);
  });
  startTurning(canvas, state, { drawSoon, moveCut, describe });
  describe(-1, -1);
  return drawSoon;
};
