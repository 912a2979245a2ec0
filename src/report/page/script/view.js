// Parallel views of boxes.

// Where a point of the unit cube is drawn, and the direction from the scene to the viewer.
const viewOf = ({ azimuth, elevation, zoom }, shape, width, height) => {
  const [a, e] = [azimuth, elevation].map((x) => (x * Math.PI) / 180);
  const right = [-Math.sin(a), Math.cos(a), 0];
  const up = [-Math.cos(a) * Math.sin(e), -Math.sin(a) * Math.sin(e), Math.cos(e)];
  const toward = [Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)];
  const scale = (zoom * 0.92 * Math.min(width, height)) / Math.sqrt(dot(shape, shape));
  const at = (u) => {
    const p = [0, 1, 2].map((k) => (u[k] - 0.5) * shape[k] * scale);
    return [width / 2 + dot(right, p), height / 2 - dot(up, p)];
  };
  return { at, toward };
};

// The corners of a rectangle u_axis = end.
const corners = (axis, end, low, high) => {
  const [b, c] = [(axis + 1) % 3, (axis + 2) % 3];
  return [[low[b], low[c]], [high[b], low[c]], [high[b], high[c]], [low[b], high[c]]].map(([x, y]) => {
    const u = [0, 0, 0];
    [u[axis], u[b], u[c]] = [end, x, y];
    return u;
  });
};
const trace = (path, points) => {
  points.forEach(([x, y], i) => (i === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
  path.closePath();
};

// Whether a point is in a parallelogram that has an area.
const covers = ([x, y], [o, p, , q]) => {
  const [e, f] = [[p[0] - o[0], p[1] - o[1]], [q[0] - o[0], q[1] - o[1]]];
  const det = e[0] * f[1] - e[1] * f[0];
  const s = ((x - o[0]) * f[1] - (y - o[1]) * f[0]) / det;
  const t = (e[0] * (y - o[1]) - e[1] * (x - o[0])) / det;
  return det !== 0 && s >= 0 && s <= 1 && t >= 0 && t <= 1;
};

// The fill of a depth: the deeper, the darker.
const shade = (depth, [least, most]) => {
  const part = most > least ? (depth - least) / (most - least) : 0.5;
  return `hsl(${205 + 25 * part} ${45 + 25 * part}% ${90 - 62 * part}%)`;
};

const styleOf = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A function that calls once before the next frame, however often it is called.
const soon = (call) => {
  let waiting = false;
  return () => {
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        call();
      });
    }
  };
};

// The names of the axes, and the numbers at their ends, beside edges of the unit cube.
const drawNames = (context, axes, at, colour, numberAt) => {
  const size = context.canvas.width;
  context.fillStyle = colour;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const [cx, cy] = at([0.5, 0.5, 0.5]);
  axes.forEach((name, k) => {
    const [b, c] = [(k + 1) % 3, (k + 2) % 3];
    const along = ([x, y]) => (part) => {
      const u = [part, part, part];
      [u[b], u[c]] = [x, y];
      return at(u);
    };
    // Beside the edge farthest from the middle of the picture, the lowest of those.
    const reach = (edge) => {
      const [x, y] = edge(0.5);
      return Math.hypot(x - cx, y - cy) + 0.01 * y;
    };
    const edges = [[0, 0], [0, 1], [1, 0], [1, 1]].map(along);
    const edge = edges.reduce((best, one) => (reach(one) > reach(best) ? one : best));
    const [x, y] = edge(0.5);
    const away = Math.hypot(x - cx, y - cy) || 1;
    const beside = (text, part, beyond) => {
      const [px, py] = edge(part);
      context.fillText(text, px + (beyond * (x - cx)) / away, py + (beyond * (y - cy)) / away);
    };
    context.font = `italic ${Math.round(size / 62)}px sans-serif`;
    beside(name, 0.5, size / 45);
    // A little inward, where the numbers of two axes do not meet.
    context.font = `${Math.round(size / 70)}px sans-serif`;
    [[0, 0.09], [1, 0.91]].forEach(([end, part]) => beside(name && numberAt(k, end), part, size / 36));
  });
};

// Turns, scales and cuts a view by pointer and keys, and describes what is at a place of the canvas.
const startTurning = (canvas, state, { drawSoon, moveCut, describe }) => {
  const turn = (azimuth, elevation) => {
    state.azimuth = (((state.azimuth + azimuth) % 360) + 360) % 360;
    state.elevation = Math.min(Math.max(state.elevation + elevation, -89), 89);
    drawSoon();
  };
  const zoom = (factor) => {
    state.zoom = Math.min(Math.max(state.zoom * factor, 0.3), 12);
    drawSoon();
  };
  const resize = () => {
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(canvas.clientWidth, 300);
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round((width * scale * 2) / 3);
    drawSoon();
  };
  const onCanvas = (event) => {
    const box = canvas.getBoundingClientRect();
    const scale = canvas.width / box.width;
    return [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
  };
  let drag = null;
  canvas.addEventListener("pointerdown", (event) => {
    drag = [event.clientX, event.clientY];
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (drag) {
      turn(-0.5 * (event.clientX - drag[0]), 0.5 * (event.clientY - drag[1]));
      drag = [event.clientX, event.clientY];
    } else {
      describe(...onCanvas(event));
    }
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, () => {
      drag = null;
    });
  }
  canvas.addEventListener("keydown", (event) => {
    const keys = {
      ArrowLeft: () => turn(-6, 0),
      ArrowRight: () => turn(6, 0),
      ArrowUp: () => turn(0, 6),
      ArrowDown: () => turn(0, -6),
      "+": () => zoom(1.15),
      "=": () => zoom(1.15),
      "-": () => zoom(1 / 1.15),
      "[": () => moveCut(state.cut - 0.02),
      "]": () => moveCut(state.cut + 0.02),
      Enter: () => describe(canvas.width / 2, canvas.height / 2),
    };
    if (event.key in keys && !event.ctrlKey && !event.metaKey && !event.altKey) {
      keys[event.key]();
      event.preventDefault();
    }
  });
  window.addEventListener("resize", resize);
  resize();
};
