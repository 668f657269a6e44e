// Small helpers to build a page's elements: text is always text, never markup.

export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value === true) made.setAttribute(key, "");
    else if (value !== false && value != null) made.setAttribute(key, value);
  }
  made.append(...present(children));
  return made;
}

// Children in lists of lists, without those that there are not.
export const present = (children) => children.flat(Infinity).filter((child) => child != null);

export function tableOf(columns, rows, caption) {
  const cells = (row) => row.map((cell) => element("td", {}, cell));
  return element("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": caption },
    element("table", {},
      element("caption", {}, caption),
      element("thead", {},
        element("tr", {}, columns.map((name) => element("th", { scope: "col" }, name)))),
      element("tbody", {}, rows.map((row) => element("tr", {}, cells(row))))));
}

// A percent-encoded name; as it stands where that is none.
export function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

export const calm = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

export const figure = (value, digits = 2) => Number(value).toFixed(digits);
