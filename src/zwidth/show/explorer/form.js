// The controls of a loop, made from what Python says of each; what is changed is told to Python, one event at a
// time: while one is being answered the newest of each control waits, so that a slow machine gets fewer moves
// and never a queue of old ones.

const STEPS = 1000;

export function render({ model, el }) {
  const form = document.createElement("form");
  form.noValidate = true;
  form.addEventListener("submit", (event) => event.preventDefault());
  const alert = make("p", { className: "problem", role: "alert" });
  const body = make("div", { className: "groups" });
  form.append(alert, body);

  const waiting = new Map();
  let busy = false;
  let number = model.told.heard || 0;
  let dragged = null;
  let typing = null; // where somebody types nothing is written over until it is told

  const row = (path) => body.querySelector(`[data-path="${CSS.escape(path)}"]`);
  const send = () => {
    if (busy || waiting.size === 0) return;
    const [key, event] = waiting.entries().next().value;
    waiting.delete(key);
    busy = true;
    number += 1;
    model.event = { ...event, number, before: row(event.path)?.dataset.text ?? "" };
  };
  const tell = (kind, path, value) => {
    const key = `${kind} ${path}`;
    waiting.delete(key); // so that it comes last: letting go is told after the last move
    waiting.set(key, { kind, path, value });
    send();
  };

  const slider = (one) => {
    const input = make("input", { type: "range", min: 0, max: STEPS, step: 1, value: Math.round(STEPS * one.place) });
    input.setAttribute("aria-label", one.label);
    input.setAttribute("aria-valuetext", one.text || "not given");
    input.addEventListener("input", () => {
      dragged = one.path;
      tell("move", one.path, input.value / STEPS);
    });
    input.addEventListener("change", () => {
      dragged = null;
      tell("release", one.path, null);
    });
    return input;
  };
  const entry = (one) => {
    const input = make("input", { type: "text", value: one.text, spellcheck: false, autocomplete: "off" });
    input.placeholder = one.required ? "" : "not given";
    input.setAttribute("aria-label", `${one.label}, typed with its unit`);
    const done = () => {
      if (typing !== one.path) return;
      typing = null;
      const own = row(one.path);
      if (input.ariaInvalid || input.value !== (own?.dataset.text ?? one.text)) tell("typed", one.path, input.value);
    }; // six digits are shown of what may have more: untouched it stays as it is
    input.addEventListener("input", () => (typing = one.path));
    input.addEventListener("change", done);
    input.addEventListener("keydown", (event) => event.key === "Enter" && done());
    return input;
  };
  let chosenFile; // kept while the rest is drawn again, so that the name of the file stays
  const choice = (one) => {
    const input = make("select", {});
    for (const [value, text] of one.words) input.append(new Option(text, value, false, value === one.text));
    input.setAttribute("aria-label", one.label);
    input.addEventListener("change", () => {
      if (one.path === "device" && chosenFile) chosenFile.value = "";
      tell("choose", one.path, input.value);
    });
    return input;
  };
  const box = (one) => {
    const input = make("input", { type: "checkbox", checked: one.text === "true" });
    input.addEventListener("change", () => tell("choose", one.path, String(input.checked)));
    return input;
  };
  const button = (one) => {
    const input = make("button", { type: "button", textContent: one.label });
    input.addEventListener("click", () => tell("press", one.path, null));
    return input;
  };
  const file = (one) => {
    if (chosenFile) return chosenFile;
    const input = make("input", { type: "file", accept: ".toml" });
    input.setAttribute("aria-label", one.label);
    input.addEventListener("change", async () => {
      const [given] = input.files;
      if (!given) return;
      if (given.size > one.largest) {
        alert.textContent = `${given.name} is larger than ${Math.floor(one.largest / 1024)} kB; a specification is a page of text`;
      } else {
        tell("upload", given.name, await given.text());
      }
    });
    input.addEventListener("click", () => (input.value = "")); // so that the same file can be given again
    chosenFile = input;
    return input;
  };

  const refuse = (own, message) => {
    if (message === own.querySelector(".problem")?.textContent) return;
    own.querySelector(".problem")?.remove();
    for (const input of own.querySelectorAll("input, select")) {
      input.ariaInvalid = message ? "true" : null;
      message ? input.setAttribute("aria-describedby", `why-${own.dataset.path}`) : input.removeAttribute("aria-describedby");
    }
    const typed = own.querySelector("[type=text]");
    if (!message && typed && typing !== own.dataset.path) typed.value = own.dataset.text;
    if (!message) return;
    own.append(make("p", { className: "problem", id: `why-${own.dataset.path}`, role: "alert", textContent: message }));
  };

  const shown = (one) => {
    const row = make("div", { className: `row ${one.sort}` });
    row.dataset.path = one.path;
    row.dataset.text = one.text ?? "";
    if (one.sort === "button") {
      row.append(button(one));
      return row;
    }
    const label = make("label", {});
    label.title = one.meaning || "";
    if (one.sort === "flag") {
      label.append(box(one), make("span", { textContent: one.label }));
      row.append(label);
      if (one.meaning) row.append(make("small", { textContent: one.meaning }));
      return row;
    }
    label.append(make("span", { textContent: one.label }));
    label.append(one.sort === "number" || one.sort === "text" ? entry(one) : one.sort === "file" ? file(one) : choice(one));
    row.append(label);
    if (one.sort === "number") row.append(slider(one));
    if (one.sort === "number" && !one.text) row.classList.add("unknown");
    if (one.below) row.append(make("small", { textContent: one.below }));
    return row;
  };

  const draw = () => {
    const focused = el_active(form)?.closest(".row")?.dataset.path;
    const kind = el_active(form)?.type;
    const unfinished = focused === typing ? el_active(form)?.value : undefined;
    const open = new Set([...body.querySelectorAll("details[open]")].map((one) => one.dataset.title));
    body.replaceChildren(
      ...model.groups.map((group) => {
        const rows = group.controls.map(shown);
        const set = make("fieldset", {});
        set.append(make("legend", { textContent: group.title }), ...rows);
        if (!group.folded) return set;
        const details = make("details", { open: open.has(group.title) });
        details.dataset.title = group.title;
        set.firstChild.className = "hidden";
        details.append(make("summary", { textContent: group.title }), set);
        return details;
      }),
    );
    if (focused !== undefined) {
      const next = row(focused)?.querySelector(`[type="${kind}"]`) || row(focused)?.querySelector("select, input, button");
      if (next && unfinished !== undefined) next.value = unfinished;
      next?.focus();
    }
  };

  const heed = () => {
    const told = model.told;
    if (told.error !== undefined) alert.textContent = told.error;
    for (const [path, [text, place]] of Object.entries(told.values || {})) {
      const own = row(path);
      if (!own) continue;
      const [typed, range] = [own.querySelector("[type=text]"), own.querySelector("[type=range]")];
      if (typed && typing !== path) typed.value = text;
      own.dataset.text = text;
      if (own.matches(".number")) own.querySelector("small")?.remove();
      if (range && dragged !== path && !waiting.has(`move ${path}`)) range.value = Math.round(STEPS * place);
      if (range) range.setAttribute("aria-valuetext", text || "not given");
      own.classList.toggle("unknown", Boolean(range) && !text);
    }
    if (told.refused) for (const own of body.querySelectorAll(".row")) refuse(own, told.refused[own.dataset.path]);
    if (told.query) window.history.replaceState(null, "", `?${told.query}${window.location.hash}`);
    if (told.file) save(told.file);
    if (told.heard >= number && busy) {
      busy = false;
      send();
    }
  };

  if (model.views) window.addEventListener("zwidth-view", (event) => tell("view", event.detail, null));

  model.on("groups", draw);
  model.on("told", heed);
  draw();
  heed();
  if (model.views) setTimeout(() => window.dispatchEvent(new Event("zwidth-drawn")));
  return form;
}

function el_active(form) {
  return form.getRootNode().activeElement;
}

function make(tag, properties) {
  return Object.assign(document.createElement(tag), properties);
}

function save({ name, kind, text }) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: kind })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
