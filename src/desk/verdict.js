const WORDS = {
  certified: ["\u2713 CERTIFIED", "Every requirement holds at every point of the workspace. The exact checker accepted the proof."],
  refuted: ["\u2717 REFUTED", "The exact checker accepted the counterexample."],
  undecided: ["UNDECIDED", "Neither a proof nor a counterexample was found within the budget."],
  refused: ["NOT A DESIGN", ""],
  defect: ["NO VERDICT", "Stopped by a defect of this program, or for want of memory."],
};

/** What is being proved, since when and how long the last took; certificates that may serve again. */
const proving = { text: null, since: 0, last: 0, kept: {}, patience: 0 };

/** Asks for the verdict on what is on the desk; of several in a row, on the newest. */
async function prove(changed = performance.now()) {
  Object.assign(desk, { changed, answer: null });
  drawer.stop();
  finder.stop();
  clearTimeout(desk.still);
  clearTimeout(proving.patience);
  if (prover.busy) {
    // A proof is given up for a newer number once it takes much longer than the last one did.
    const most = Math.max(PATIENCE, 2 * proving.last) - (performance.now() - proving.since);
    const giveUp = () => desk.text !== proving.text && prover.stop();
    proving.patience = setTimeout(giveUp, Math.max(0, most));
    return;
  }
  const { text, file } = desk;
  Object.assign(proving, { text, since: performance.now() });
  const limit = setTimeout(() => prover.stop(), LONGEST);
  const slow = setTimeout(showWork, PATIENCE);
  if (desk.unread) {
    const found = await prover.ask({ ask: "numbers", text, file });
    if (found?.numbers && text === desk.text) {
      desk.unread = false;
      at("sliders").disabled = !found.numbers.length;
      showNumbers(found.numbers);
    }
  }
  const before = Object.values(proving.kept).filter(Boolean);
  const isNewest = () => text === desk.text;
  const answer = isNewest() ? await prover.ask({ ask: "verdict", text, file, before }) : null;
  [limit, slow, proving.patience].forEach(clearTimeout);
  if (answer) {
    proving.last = performance.now() - proving.since;
    show(answer, text, changed);
  } else if (isNewest()) {
    show({ verdict: "undecided", late: true }, text, changed);
  }
  if (!isNewest()) {
    prove(desk.changed);
  }
}

/** Says that the verdict on the screen is not of what is on the desk. */
function showWork() {
  at("verdict").classList.add("pending");
  at("keep-certificate").disabled = at("keep-report").disabled = true;
  at("effort").textContent = "Proving. The verdict above is of the design before this change.";
}

/** Shows an answer. */
function show(answer, text, changed) {
  const state = answer.defect ? "defect" : answer.refused === undefined ? answer.verdict : "refused";
  if (answer.certificate && answer.certificate.length < LONG) {
    // The newest of each verdict; that of this one is tried first.
    const other = state === "certified" ? "refuted" : "certified";
    proving.kept = { [state]: answer.certificate, [other]: proving.kept[other] };
  }
  desk.answer = text === desk.text ? { ...answer, text } : null;
  const verdict = at("verdict");
  verdict.classList.remove("pending");
  verdict.className = `verdict ${state === "defect" ? "refused" : state}`;
  const [headline, meaning] = WORDS[state];
  if (at("headline").textContent !== headline) {
    at("headline").textContent = headline;
  }
  at("of").textContent = answer.title ?? "";
  const notes = (answer.notes ?? []).map((note) => ` Note: ${note}.`);
  at("meaning").textContent = (meaningOf(answer, state) ?? meaning) + notes.join("");
  at("refusal").hidden = state !== "refused";
  at("refusal").textContent = answer.refused ?? "";
  at("statement").textContent = answer.statement ?? "Nothing yet.";
  if (state !== "refused" && state !== "defect" && !answer.late) {
    at("drawing").innerHTML = answer.drawing ?? "";
    at("no-drawing").hidden = answer.drawing !== null;
  }
  const current = text === desk.text;
  at("keep-certificate").disabled = at("keep-report").disabled = !answer.certificate;
  at("find").disabled = state === "refused";
  at("effort").textContent = effortOf(answer, performance.now() - changed);
  Object.assign(verdict.dataset, { state, shown: Number(verdict.dataset.shown ?? 0) + 1 });
  if (current) {
    desk.still = setTimeout(drawFigures, STILL);
  }
}

function meaningOf({ counterexample, remains, late }, state) {
  if (late) {
    return `Neither a proof nor a counterexample was found within ${LONGEST / 1000} s, the budget of this page; orthocert verify has more.`;
  }
  if (remains) {
    const helps = remains.open.map(({ requirement, help }) => `${requirement}: ${help}`);
    return `${WORDS.undecided[1]} Why: ${remains.reason}. ${helps.slice(0, 2).join(". ")}`;
  }
  if (state !== "refuted" || !counterexample) {
    return null;
  }
  const { violated, value, point, other_point: other, machine, bodies = [] } = counterexample;
  const between = bodies.length ? `, of ${bodies.map(({ body }) => body).join(" and ")}` : "";
  const place = `at (${point.join(", ")})${other ? ` and at (${other.join(", ")})` : ""}`;
  const parts = Object.entries(machine ?? {}).map(([name, value]) => `${name} = ${value}`);
  const setting = parts.length ? `, for ${parts.join(", ")}` : "";
  return `${violated} is violated: ${value}${between} ${place}${setting}.`;
}

function effortOf({ size, certificate, verdict }, milliseconds) {
  const parts = [];
  if (size) {
    parts.push(`${size.leaves} ${size.leaves === 1 ? "leaf" : "leaves"} of ${size.boxes} ${size.boxes === 1 ? "box" : "boxes"}, ${size.bits} bits`);
  }
  if (certificate) {
    parts.push(`certificate of ${certificate.length} bytes`);
  }
  if (verdict) {
    parts.push(`${Math.round(milliseconds)} ms from the change to the verdict`);
  }
  return parts.join("; ");
}
