// axe-core in the page under test, past its content security policy, which stays in force.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";

const source = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const rules = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

/// Violations in words; empty where there are none.
export async function violations(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(source);
  const found = await page.evaluate((runOnly) => window.axe.run(document, { runOnly }), rules);
  return found.violations.map((violation) =>
    `${violation.id}: ${violation.help}\n${violation.nodes.map((node) => `${node.html}\n${node.failureSummary}`).join("\n")}`);
}
