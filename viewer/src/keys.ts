// Keys that do what buttons do, unless a control that has the focus needs them itself.

export function listenToKeys(acts: Record<string, () => void>, after: () => void): void {
  addEventListener('keydown', (event) => {
    const at = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || /^(SELECT|TEXTAREA)$/.test(at.tagName)) return;
    const isControl = /^(INPUT|BUTTON|SUMMARY)$/.test(at.tagName);
    if (isControl && (event.key === ' ' || event.key.startsWith('Arrow'))) return;
    const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
    after();
  });
}
