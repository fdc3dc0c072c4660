#include "experiments/stability/html.h"

#include "figures/text.h"

namespace penumbra::experiments::html {
namespace {

using figures::escaped;

constexpr const char* style = R"(
:root { color-scheme: light dark; --ground: #fff; --ink: #1b1b1b; --soft: #545454; --line: #d4d4d4; }
@media (prefers-color-scheme: dark) { :root { --ground: #171717; --ink: #ededed; --soft: #b0b0b0; --line: #3a3a3a; } }
body { margin: 0 auto; padding: 2rem; max-width: 90rem; background: var(--ground); color: var(--ink); font: 16px/1.5 system-ui, "Helvetica Neue", Arial, sans-serif; }
p { max-width: 46rem; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 0.25rem 1.2rem; }
dt { color: var(--soft); }
dd { margin: 0; }
figure { margin: 1rem 0; overflow-x: auto; }
figure svg { display: block; max-width: 100%; height: auto; border-radius: 6px; }
.table { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.6rem; text-align: start; vertical-align: top; border-block-end: 1px solid var(--line); }
th button { all: unset; cursor: pointer; font-weight: 600; }
th button:focus-visible { outline: 2px solid; }
th[aria-sort="ascending"] button::after { content: " \2191"; }
th[aria-sort="descending"] button::after { content: " \2193"; }
input { font: inherit; padding: 0.3rem; margin-block: 0.5rem; }
)";

constexpr const char* script = R"(
for (const table of document.querySelectorAll('table')) {
  const body = table.tBodies[0];
  const key = (row, column) => {
    const cell = row.cells[column];
    return cell.dataset.number === undefined ? cell.textContent : Number(cell.dataset.number);
  };
  const compare = (a, b) => typeof a === 'number' && typeof b === 'number' ? a - b : String(a).localeCompare(String(b));
  [...table.tHead.rows[0].cells].forEach((head, column) => head.firstChild.addEventListener('click', () => {
    const down = head.getAttribute('aria-sort') === 'ascending';
    for (const other of table.tHead.rows[0].cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const rows = [...body.rows].sort((a, b) => compare(key(a, column), key(b, column)));
    if (down) rows.reverse();
    body.append(...rows);
  }));
  const filter = table.parentElement.querySelector('input');
  filter.addEventListener('input', () => {
    for (const row of body.rows) row.hidden = !row.textContent.toLowerCase().includes(filter.value.toLowerCase());
  });
}
)";

}  // namespace

Page::Page(const std::string& title) : title_(title) {}

void Page::heading(const std::string& text) {
  body_ += "<h2>" + escaped(text) + "</h2>\n";
}

void Page::paragraph(const std::string& text) {
  body_ += "<p>" + escaped(text) + "</p>\n";
}

void Page::facts(const std::vector<std::pair<std::string, std::string>>& list) {
  body_ += "<dl>";
  for (const auto& [name, value] : list)
    body_ += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
  body_ += "</dl>\n";
}

void Page::figure(const std::string& svg) {
  body_ += "<figure>" + svg + "</figure>\n";
}

void Page::table(const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& rows) {
  body_ +=
      "<div class=\"table\" tabindex=\"0\"><label>Rows that contain <input type=\"search\"></label>"
      "<table><thead><tr>";
  for (const std::string& column : columns)
    body_ += "<th scope=\"col\"><button type=\"button\">" + escaped(column) + "</button></th>";
  body_ += "</tr></thead>\n<tbody>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (const Cell& cell : row)
      body_ += (cell.is_number() ? "<td data-number=\"" + std::to_string(cell.number) + "\">"
                                 : std::string("<td>")) +
               escaped(cell.text) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

std::string Page::text() const {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>" +
         escaped(title_) + "</title>\n<style>" + style + "</style></head>\n<body><h1>" +
         escaped(title_) + "</h1>\n" + body_ + "<script>" + script + "</script></body></html>\n";
}

}  // namespace penumbra::experiments::html
