// Proves the page's claim again, by the formally verified checker.

const startReproof = () => {
  const certificate = document.getElementById("certificate");
  const note = document.getElementById("reproved");
  if (!certificate || !note) return;
  const box = note.closest(".verdict");
  const say = (state, words) => {
    note.dataset.state = state;
    note.textContent = words;
  };
  const reject = (words) => {
    box.className = "verdict rejected";
    box.querySelector("strong").textContent = "\u2717 REJECTED";
    box.querySelector("p").textContent = "Trust nothing on this page.";
    say("rejected", words);
  };
  const prove = () => {
    const start = performance.now();
    let answer;
    try {
      answer = globalThis.orthocert_verify(JSON.parse(certificate.textContent));
    } catch {
      answer = "REJECTED";
    }
    const time = Math.max(1, Math.round(performance.now() - start));
    if (answer.toLowerCase() === box.dataset.verdict) {
      say("accepted", `This page proved its claim again in your browser, in ${time} ms, with the formally verified checker.`);
    } else if (answer.startsWith("NOT COVERED: ")) {
      const what = answer.slice(13);
      say("not-covered", `${what[0].toUpperCase()}${what.slice(1)}; the exact checker accepted the certificate.`);
    } else {
      reject("The formally verified checker does not accept the certificate that is in this page.");
    }
  };
  // After the page is drawn.
  requestAnimationFrame(() => setTimeout(prove));
};
