/** The state as it stands after the number sign of the address. */
function address() {
  const machine = desk.machines.find(({ text }) => text === desk.text);
  const name = (machine?.file ?? desk.file).replace(/\.toml$/, "");
  return `#machine=${name}${machine ? "" : `&design=${encodeURIComponent(desk.text)}`}`;
}

/** Makes the state one to which the back button leads. */
function remember() {
  if (location.hash !== address()) {
    location.hash = address();
  }
}

/** Lays the design of the address on the desk, or the first machine. */
function recall() {
  const said = new URLSearchParams(location.hash.slice(1));
  const named = desk.machines.find(({ file }) => file === `${said.get("machine")}.toml`);
  const { file, text } = named ?? desk.machines[0];
  lay(file, said.get("design") ?? text);
}

/** Lays a design on the desk, made from this machine's, and proves it. */
function lay(file, text) {
  Object.assign(desk, { file, text, unread: true });
  at("machine").value = file;
  if (at("text").value !== text) {
    at("text").value = text;
  }
  prove();
}

at("machine").addEventListener("change", () => {
  const { file, text } = desk.machines.find((machine) => machine.file === at("machine").value);
  lay(file, text);
  remember();
});
at("text").addEventListener("input", () => {
  // Until the new text is read, nobody knows where its numbers are.
  desk.unread = true;
  at("sliders").disabled = true;
  desk.text = at("text").value;
  prove();
});
at("text").addEventListener("change", remember);
at("form").addEventListener("submit", (event) => event.preventDefault());
window.addEventListener("hashchange", () => {
  if (location.hash !== address()) {
    recall();
  }
});
const isDark = () =>
  document.documentElement.dataset.theme
    ? document.documentElement.dataset.theme === "dark"
    : matchMedia("(prefers-color-scheme: dark)").matches;

/** What the button changes to. */
function nameTheme() {
  at("theme").textContent = isDark() ? "Light" : "Dark";
}

at("theme").addEventListener("click", () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  nameTheme();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", nameTheme);
nameTheme();

prover.ask({ ask: "machines" }).then(({ machines }) => {
  desk.machines = machines;
  at("machine").replaceChildren(...machines.map(({ name, file }) => new Option(name, file)));
  recall();
});
