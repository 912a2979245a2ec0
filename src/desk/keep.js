/** The name of files without its ending. */
const stem = () => desk.file.replace(/\.toml$/, "");

function keep(name, text, type) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** What the sections and the report of the certificate are asked with. */
const aboutCertificate = () => ({
  certificate: desk.answer.certificate,
  file: `${stem()}.cert.json`,
  title: desk.answer.title ?? stem(),
});

at("keep-design").addEventListener("click", () => keep(`${stem()}.toml`, desk.text, "application/toml"));
at("keep-certificate").addEventListener("click", () => {
  if (desk.answer?.certificate) {
    keep(`${stem()}.cert.json`, desk.answer.certificate, "application/json");
  }
});
at("keep-report").addEventListener("click", async () => {
  if (!desk.answer?.certificate) {
    return;
  }
  const name = `${stem()}.report.html`;
  clearTimeout(desk.still);
  const answer = await drawer.ask({ ask: "report", ...aboutCertificate() });
  if (answer?.html) {
    keep(name, answer.html, "text/html");
    drawFigures();
  }
});

/** Draws the maps of what was decided, once nothing moves. */
async function drawFigures() {
  const { answer } = desk;
  if (!answer?.certificate || answer.certificate === desk.drawn) {
    at("figures").setAttribute("aria-busy", String(!answer?.certificate));
    return;
  }
  at("figures").setAttribute("aria-busy", "true");
  const anchors = ["overview", "maps", "still"];
  const found = await drawer.ask({ ask: "sections", ...aboutCertificate(), anchors });
  if (found?.sections) {
    desk.drawn = answer.certificate;
    at("figures").innerHTML = found.sections.join("");
    at("figures").setAttribute("aria-busy", "false");
  }
}

/** The number whose limits are most asked for. */
const CYLINDER = "workspace.cylinder.radius";

function chooseKeys(numbers) {
  const keys = numbers.map(({ key }) => key);
  at("key").replaceChildren(...keys.map((key) => new Option(key, key)));
  if (keys.includes(CYLINDER)) {
    at("key").value = CYLINDER;
  }
  at("found").replaceChildren();
  nameSearch();
}

function nameSearch() {
  at("find").textContent =
    at("key").value === CYLINDER ? "Find the largest cylinder" : "Find its limits";
}

at("key").addEventListener("change", nameSearch);
at("find").addEventListener("click", async () => {
  const { text, file } = desk;
  const key = at("key").value;
  const started = performance.now();
  at("found").textContent = `Looking how far ${key} goes\u2026`;
  const answer = await finder.ask({ ask: "limit", text, file, key });
  if (!answer) {
    at("found").textContent = "Stopped: the design was changed.";
  } else if (answer.limits) {
    const seconds = ((performance.now() - started) / 1000).toFixed(1);
    at("found").replaceChildren(...answer.limits.map((limit) => limitOf(limit, answer)));
    at("found").append(paragraph(`${key} = ${answer.own} in the design; ${seconds} s.`));
  } else {
    at("found").textContent = answer.refused ?? WORDS.defect[1];
  }
});

function paragraph(text) {
  const note = document.createElement("p");
  note.className = "note";
  note.textContent = text;
  return note;
}

/** A limit: what is certified, what is refuted, and what limits. */
function limitOf(limit, { key }) {
  const box = document.createElement("div");
  box.className = "limit";
  const title = document.createElement("h3");
  const both = limit.certified && limit.refuted;
  title.textContent = both ? `${limit.side === "upper" ? "Upper" : "Lower"} limit` : `No ${limit.side} limit found`;
  const list = document.createElement("dl");
  const line = (name, value) => {
    if (value) {
      const [dt, dd] = ["dt", "dd"].map((tag) => document.createElement(tag));
      dt.textContent = name;
      dd.textContent = value;
      list.append(dt, dd);
    }
  };
  line("certified", limit.certified);
  line("refuted", limit.refuted);
  if (limit.place) {
    line("limited by", limit.place.violated);
    line("value there", limit.place.value);
    line("at", `(${limit.place.point.join(", ")})`);
  }
  line("undecided", limit.undecided && limit.undecided.join(" to "));
  line("not a design", limit.end);
  box.append(title, list);
  const number = desk.numbers.find((other) => other.key === key);
  if (number && limit.certified && limit.certified !== number.value) {
    const use = document.createElement("button");
    use.type = "button";
    use.textContent = `Use ${limit.certified}`;
    use.addEventListener("click", () => {
      put(desk.numbers.find((other) => other.key === key), limit.certified);
      desk.unread = true;
      prove();
      remember();
    });
    box.append(use);
  }
  return box;
}
