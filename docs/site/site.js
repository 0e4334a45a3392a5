// The search of the site: names of the reference and headings of the pages, from search_index.js.
(() => {
  const up = document.currentScript.dataset.up;
  const input = document.getElementById('search');
  const found = document.getElementById('found');
  const kMost = 12;
  let chosen = 0;

  // Lower is better: the whole name, its beginning, a part of it; undefined where a word is missing.
  function rank([name], words) {
    const full = name.toLowerCase();
    const last = full.split('::').pop();
    let sum = 0;
    for (const word of words) {
      if (!full.includes(word)) return undefined;
      sum += last === word ? 0 : last.startsWith(word) ? 1 : last.includes(word) ? 2 : 3;
    }
    return sum + full.length / 1000;
  }

  function choose(index) {
    const links = found.querySelectorAll('a');
    if (!links.length) return;
    chosen = (index + links.length) % links.length;
    links.forEach((link, i) => link.classList.toggle('chosen', i === chosen));
  }

  function search() {
    const words = input.value.toLowerCase().split(/[\s()]+/).filter(Boolean);
    const hits = words.length ? searchIndex.map((entry) => [rank(entry, words), entry]).filter(([r]) => r !== undefined) : [];
    hits.sort(([a], [b]) => a - b);
    const entries = new Map(hits.map(([, entry]) => [entry[2], entry]));
    found.replaceChildren(...[...entries.values()].slice(0, kMost).map(([name, kind, address]) => {
      const item = document.createElement('li');
      const link = item.appendChild(document.createElement('a'));
      link.href = up + address;
      link.append(name.replace(/^textplane::/, ''), Object.assign(document.createElement('small'), {textContent: kind}));
      return item;
    }));
    if (words.length && !hits.length) found.append(Object.assign(document.createElement('li'), {textContent: 'Nothing found'}));
    found.hidden = !words.length;
    choose(0);
  }

  input.addEventListener('input', search);
  input.addEventListener('focus', search);
  input.addEventListener('keydown', (event) => {
    if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      event.preventDefault();
      choose(chosen + (event.key === 'ArrowDown' ? 1 : -1));
    } else if (event.key === 'Enter') {
      found.querySelector('a.chosen')?.click();
    } else if (event.key === 'Escape') {
      input.blur();
      found.hidden = true;
    }
  });
  document.addEventListener('keydown', (event) => {
    if (event.key !== '/' || event.target.matches('input')) return;
    event.preventDefault();
    input.focus();
  });
  document.addEventListener('click', (event) => {
    if (!event.target.closest('.search')) found.hidden = true;
  });
})();
