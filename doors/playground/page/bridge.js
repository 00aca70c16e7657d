// In the frame of the arm, after the scripts of its page: what the playground asks of it, and what it tells unasked. The
// frame has an origin of its own, so messages are all that passes.

(() => {
  const root = document.documentElement;
  const tell = (what) => parent.postMessage(what, "*");
  addEventListener("message", ({ source, data }) => {
    if (source !== parent) return;
    try {
      if (data.ask === "view") tell({ view: rne.view() });
      if (data.show) rne.show(data.show);
      if (data.address) rne.showAddress(`#${data.address}`);
    } catch (error) {
      // a page that cannot be looked at as the one before is shown as it is
      tell({ view: null });
      throw error;
    } finally {
      if (data.show) tell({ shown: true });
    }
  });
  root.addEventListener("address", ({ detail }) => tell({ address: detail }));
  addEventListener("load", () => tell({ title: document.title }));
  const colours = () => tell({ theme: root.dataset.theme || "" });
  new MutationObserver(colours).observe(root, { attributes: true, attributeFilter: ["data-theme"] });
  colours();
  new ResizeObserver(() => tell({ height: document.body.scrollHeight })).observe(document.body);
})();
