for (const table of document.querySelectorAll('table')) {
  const body = table.tBodies[0];
  const key = (row, column) => {
    const { number } = row.cells[column].dataset;
    return number === undefined ? row.cells[column].textContent : Number(number);
  };
  // Numbers before texts, so that the order is one whatever a column mixes.
  const compare = (a, b) => {
    if (typeof a !== typeof b) return typeof a === 'number' ? -1 : 1;
    return typeof a === 'number' ? a - b : a.localeCompare(b);
  };
  [...table.tHead.rows[0].cells].forEach((head, column) => {
    head.firstChild.addEventListener('click', () => {
      const down = head.getAttribute('aria-sort') === 'ascending';
      for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
      head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      const rows = [...body.rows].sort((a, b) => compare(key(a, column), key(b, column)));
      body.append(...(down ? rows.reverse() : rows));
    });
  });
  const filter = table.parentElement.querySelector('input');
  filter?.addEventListener('input', () => {
    const wanted = filter.value.toLowerCase();
    for (const row of body.rows) row.hidden = !row.textContent.toLowerCase().includes(wanted);
  });
}
for (const button of document.querySelectorAll('.pictures button')) {
  button.addEventListener('click', () => button.parentElement.classList.toggle('large'));
}
