// Tabs as the keyboard expects them: arrows go from one to the next; the address keeps which one is open.
(() => {
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const open = (tab, focus) => {
    for (const one of tabs) {
      const on = one === tab;
      one.setAttribute("aria-selected", String(on));
      one.tabIndex = on ? 0 : -1;
      document.getElementById(one.getAttribute("aria-controls")).hidden = !on;
    }
    if (focus) tab.focus();
    window.dispatchEvent(new Event("resize"));
    window.dispatchEvent(new CustomEvent("zwidth-view", { detail: tab.id.slice(4) }));
  };
  const named = () => tabs.find((tab) => `#${tab.id.slice(4)}` === window.location.hash);
  for (const [at, tab] of tabs.entries()) {
    const go = (to) => {
      open(to, true);
      window.history.replaceState(null, "", `${window.location.search}#${to.id.slice(4)}`);
    };
    tab.addEventListener("click", () => go(tab));
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      const end = { Home: 0, End: tabs.length - 1 }[event.key];
      if (step === undefined && end === undefined) return;
      event.preventDefault();
      go(tabs[end ?? (at + step + tabs.length) % tabs.length]);
    });
  }
  window.addEventListener("hashchange", () => named() && open(named(), false));
  open(named() || tabs[0], false);
  // what listens is drawn after this has run: it asks which one is open
  window.addEventListener("zwidth-drawn", () => {
    document.getElementById("first")?.remove();
    open(tabs.find((tab) => tab.tabIndex === 0), false);
  });
})();
