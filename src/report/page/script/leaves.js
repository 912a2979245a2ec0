// The leaves of a tree, from its code: a letter for each rule used on a node, then X, Y or Z for a
// split on that axis, T for one of a tolerance, whose halves have the same box, or a point.

const leavesOf = (tree, rules, discharges, obligations) => {
  const count = (tree.code.match(/\./g) || []).length;
  const leaves = {
    count,
    low: new Float64Array(3 * count),
    high: new Float64Array(3 * count),
    depth: new Uint16Array(count),
    by: new Int8Array(obligations * count).fill(-1),
  };
  const asked = new Set([...tree.code].map((c) => discharges[c.charCodeAt(0) - 97]));
  const waiting = [{ low: [0, 0, 0], high: [1, 1, 1], depth: 0, by: new Array(obligations).fill(-1) }];
  let [node, by, leaf] = [waiting.pop(), null, 0];
  for (const c of tree.code) {
    by = by || node.by.slice();
    const axis = "XYZ".indexOf(c);
    if (axis < 0 && c !== "." && c !== "T") {
      const rule = c.charCodeAt(0) - 97;
      by.forEach((known, o) => {
        if (known < 0 && asked.has(o) && (discharges[rule] === o || discharges[rule] < 0)) {
          by[o] = rule;
        }
      });
      continue;
    }
    if (c === ".") {
      leaves.low.set(node.low, 3 * leaf);
      leaves.high.set(node.high, 3 * leaf);
      leaves.depth[leaf] = node.depth;
      leaves.by.set(by, obligations * leaf);
      leaf += 1;
    } else {
      const middle = (node.low[axis] + node.high[axis]) / 2;
      const half = (low, high) => ({ low, high, depth: node.depth + 1, by });
      const [below, above] = [node.high.slice(), node.low.slice()];
      if (axis >= 0) {
        below[axis] = middle;
        above[axis] = middle;
      }
      waiting.push(half(above, node.high), half(node.low, below));
    }
    node = waiting.pop();
    by = null;
  }
  return leaves;
};
