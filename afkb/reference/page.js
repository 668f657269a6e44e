// Shows one thing at a time: a term (#Mug), a section (#objects), what fits the filter
// (#filter=wood), everything (#all), or else the overview. Without scripts everything is shown.
const box = document.getElementById("filter");
const shown = document.getElementById("shown");
const nav = document.querySelector("nav");
const main = document.querySelector("main");
const sections = [...document.querySelectorAll("main > section")];
const terms = [...document.querySelectorAll("article, tr.term")];
const lists = [...document.querySelectorAll("#index details")];
const entries = new Map([...document.querySelectorAll("#index li a")]
  .map((a) => [a.getAttribute("href").slice(1), a]));
const textOf = (term) => (term.querySelector(":scope > header") || term).textContent.toLowerCase();
let texts = null;

function showOnly(fits) {
  for (const term of terms) term.hidden = !fits(term);
  for (const part of [...sections, ...document.querySelectorAll(".words")]) {
    part.hidden = !part.querySelector("article:not([hidden]), tr.term:not([hidden])");
  }
}

// All the words must be in a term's head, whatever their order.
function showFitting(asked) {
  texts = texts || new Map(terms.map((term) => [term, textOf(term)]));
  const words = asked.split(/\s+/);
  showOnly((term) => words.every((word) => texts.get(term).includes(word)));
  const count = terms.filter((term) => !term.hidden).length;
  shown.textContent = `${count} of ${terms.length} terms`;
  for (const [id, a] of entries) a.parentNode.hidden = document.getElementById(id).hidden;
  for (const list of lists) {
    list.hidden = !list.querySelector("li:not([hidden])");
    list.open = !list.hidden;
  }
  main.dataset.view = "filter";
  scrollTo(0, 0);
}

function showWholeIndex() {
  shown.textContent = "";
  for (const a of entries.values()) a.parentNode.hidden = false;
  for (const list of lists) list.hidden = false;
}

function mark(id) {
  for (const a of entries.values()) a.removeAttribute("aria-current");
  const entry = entries.get(id);
  const own = lists.find((list) => list.contains(entry) || list.dataset.section === id);
  for (const list of lists) list.open = list === (own || lists[0]);
  if (!entry) return;
  entry.setAttribute("aria-current", "true");
  nav.scrollTop = entry.offsetTop - nav.clientHeight / 2;
}

function showPlace(id) {
  const place = document.getElementById(id);
  const section = place && place.closest("main > section");
  const alone = place !== null && place.tagName === "ARTICLE";
  showWholeIndex();
  if (id === "all") showOnly(() => true);
  else if (alone) showOnly((term) => term === place);
  else showOnly((term) => section !== null && section !== undefined && section.contains(term));
  document.getElementById("overview").hidden = Boolean(section) && section.id !== "overview";
  main.dataset.view = alone ? "term" : section && section.id !== "overview" ? "section" : "home";
  mark(id);
  if (place && place.tagName === "TR") place.scrollIntoView(); else scrollTo(0, 0);
}

function follow() {
  if (nav.contains(document.activeElement)) document.activeElement.blur();
  const hash = decodeURIComponent(location.hash.slice(1));
  const asked = hash.startsWith("filter=") ? hash.slice("filter=".length) : "";
  box.value = asked;
  if (asked) showFitting(asked.toLowerCase()); else showPlace(hash);
}

function filter() {
  const asked = box.value.trim().toLowerCase();
  if (asked) showFitting(asked); else showPlace(decodeURIComponent(location.hash.slice(1)));
}

const go = (term) => { if (term) location.hash = term.id; };

// A term of that very name or label, else the first that is shown.
function best() {
  const asked = box.value.trim().toLowerCase();
  const named = (term) => [term.id, term.querySelector("h3 a, b")?.textContent]
    .some((name) => name?.toLowerCase() === asked);
  return terms.find(named) || terms.find((term) => !term.hidden);
}

function step(by) {
  const articles = [...document.querySelectorAll("article")];
  const at = articles.findIndex((term) => `#${term.id}` === location.hash);
  go(articles[Math.max(0, Math.min(articles.length - 1, at < 0 ? 0 : at + by))]);
}

box.addEventListener("input", filter);
addEventListener("hashchange", follow);
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target === box) {
    if (event.key === "Enter") { go(best()); box.blur(); follow(); }
    if (event.key === "Escape") { box.value = ""; filter(); box.blur(); }
    return;
  }
  if (event.key === "/") { event.preventDefault(); box.focus(); box.select(); }
  if (event.key === "Escape") location.hash = "";
  if (event.key === "j") step(1);
  if (event.key === "k") step(-1);
});
follow();
