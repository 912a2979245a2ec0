/** The exact decimal `base + n 10^-places`. */
function moved(base, n, places) {
  const [whole, part = ""] = base.replace("-", "").split(".");
  const digits = Math.max(part.length, places, 0);
  let value = BigInt(whole + part.padEnd(digits, "0"));
  if (base.startsWith("-")) {
    value = -value;
  }
  value += BigInt(n) * 10n ** BigInt(digits - places);
  const text = String(value < 0n ? -value : value).padStart(digits + 1, "0");
  const fraction = text.slice(text.length - digits).replace(/0+$/, "");
  const sign = value < 0n ? "-" : "";
  return sign + text.slice(0, text.length - digits) + (digits && fraction ? `.${fraction}` : "");
}

/** How far a slider goes to either side, in steps of a power of ten. */
function scaleOf(number) {
  const half = 0.4 * number.size;
  const places = -Math.floor(Math.log10(half / 100));
  return { places, most: Math.max(1, Math.round(half * 10 ** places)) };
}

/** The text with another literal in the number's places; the places of all numbers move with it. */
function put(number, value) {
  let shift = 0;
  const old = desk.text;
  const all = desk.numbers.flatMap((other) => other.places.map((place) => ({ other, place })));
  all.sort((a, b) => a.place[0] - b.place[0]);
  let text = "";
  let done = 0;
  for (const { other, place } of all) {
    const [from, to] = place;
    place[0] += shift;
    if (other === number) {
      const own = old.slice(from, to);
      const spread = number.tolerance === null ? "" : ` \u00b1 ${number.tolerance}`;
      const quote = /^['"]/.test(own) ? own[0] : spread && '"';
      const literal = `${quote}${value}${spread}${quote}`;
      text += old.slice(done, from) + literal;
      done = to;
      shift += literal.length - (to - from);
    }
    place[1] += shift;
  }
  number.value = value;
  desk.text = text + old.slice(done);
  at("text").value = desk.text;
}

/** Whether a number is a coordinate of a leg's direction or place, of which there are many. */
const isPlace = ({ key }) => key.startsWith("mechanism.") && /\.\d+$/.test(key);

/** Rows of sliders, kept while their keys stay the same. */
const rows = { keys: "", all: [] };

function rowOf(number, i) {
  const row = document.createElement("div");
  row.className = "slider";
  const label = document.createElement("label");
  label.htmlFor = `number-${i}`;
  label.textContent = number.key;
  const output = document.createElement("output");
  output.htmlFor = label.htmlFor;
  const input = document.createElement("input");
  Object.assign(input, { type: "range", id: label.htmlFor, step: 1 });
  row.append(label, output, input);
  const kept = { row, label, output, input, base: number.value, scale: scaleOf(number) };
  const rest = () => {
    const now = desk.numbers[i];
    Object.assign(kept, { base: now.value, scale: scaleOf(now) });
    input.min = -kept.scale.most;
    input.max = kept.scale.most;
    input.value = 0;
  };
  kept.rest = rest;
  input.addEventListener("input", () => {
    const changed = performance.now();
    put(desk.numbers[i], moved(kept.base, Number(input.value), kept.scale.places));
    tell(kept, desk.numbers[i]);
    prove(changed);
  });
  input.addEventListener("keydown", (event) => {
    const step = { PageUp: 1, PageDown: -1 }[event.key];
    if (step) {
      event.preventDefault();
      input.value = Number(input.value) + step * Math.round(kept.scale.most / 10);
      input.dispatchEvent(new Event("input"));
      input.dispatchEvent(new Event("change"));
    }
  });
  input.addEventListener("change", () => {
    remember();
    // At an end there is more beyond.
    if (Math.abs(Number(input.value)) === kept.scale.most) {
      rest();
    }
  });
  return kept;
}

function tell({ output, input }, { value, tolerance }) {
  output.textContent = tolerance === null ? value : `${value} \u00b1 ${tolerance}`;
  input.setAttribute("aria-valuetext", output.textContent);
}

/** Shows the numbers of the design. */
function showNumbers(numbers) {
  desk.numbers = numbers;
  const keys = JSON.stringify([desk.file, numbers.map(({ key }) => key)]);
  if (keys !== rows.keys) {
    rows.keys = keys;
    rows.all = numbers.map(rowOf);
    const rank = ({ key }) => ["workspace", "requirements"].indexOf(key.split(".")[0]) >>> 0;
    const order = numbers.map((number, i) => ({ number, i }));
    order.sort((a, b) => rank(a.number) - rank(b.number) || a.i - b.i);
    const parts = [[], []];
    order.forEach(({ number, i }) => parts[isPlace(number) ? 1 : 0].push(rows.all[i].row));
    at("main-numbers").replaceChildren(...parts[0]);
    at("more-numbers").replaceChildren(...parts[1]);
    at("more").hidden = !parts[1].length;
    rows.all.forEach((row) => row.rest());
    chooseKeys(order.map(({ number }) => number));
  }
  numbers.forEach((number, i) => {
    const row = rows.all[i];
    const reached = moved(row.base, Number(row.input.value), row.scale.places);
    if (reached !== number.value) {
      row.rest();
    }
    tell(row, number);
  });
}
