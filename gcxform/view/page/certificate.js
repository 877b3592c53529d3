// The certificate as a page to read: what was done, what was checked, and what was not.

export function showCertificate(page, certificate) {
  const verdict = child(page, "p", verdictOf(certificate));
  verdict.className = `verdict ${certificate.verified ? "good" : "bad"}`;
  child(page, "p", "Lengths are in mm, angles in degrees.").className = "units";
  tableOf(page, "Programs", [...pairs("source ", certificate.source), ...pairs("output ", certificate.output)]);
  listOf(page, "What was done", certificate.steps.map((step) => told(step)));
  tableOf(page, "Budget", pairs("", certificate.budget));
  tableOf(page, "Largest deviation", pairs("", certificate.largest));
  tableOf(page, "Checked", pairs("", certificate.checked));
  tableOf(page, "Measured", pairs("", certificate.measured));
  tableOf(page, "Growth", pairs("", certificate.growth));
  listOf(page, "Not checked", certificate.not_checked);
  listOf(page, "Assumed", certificate.assumed);
  listOf(page, "Written out", certificate.written_out);
  inventoryOf(page, certificate.inventory ?? {});
}

function verdictOf({ verified, largest, budget }) {
  if (!verified) return "NOT VERIFIED";
  if (!largest?.deviation && largest?.deviation !== 0) return "PASS";
  return `PASS: largest deviation ${largest.deviation.toFixed(5)} mm of ${budget.deviation.toFixed(5)} mm`;
}

function child(parent, kind, text = "") {
  const made = document.createElement(kind);
  made.textContent = text;
  parent.append(made);
  return made;
}

function pairs(before, values) {
  return Object.entries(values ?? {}).map(([name, value]) => [`${before}${name.replaceAll("_", " ")}`, told(value)]);
}

function told(value) {
  if (value === null) return "none";
  if (typeof value === "number") return String(Number(value.toPrecision(8)));
  if (typeof value !== "object") return String(value);
  if (Array.isArray(value)) return value.map(told).join(", ");
  return Object.entries(value).map(([name, inner]) => `${name}: ${told(inner)}`).join("; ");
}

function tableOf(page, title, rows) {
  if (!rows.length) return;
  child(page, "h2", title);
  const table = child(page, "table");
  for (const [name, value] of rows) {
    const row = child(table, "tr");
    child(row, "th", name);
    child(row, "td", value);
  }
}

function listOf(page, title, items) {
  if (!items?.length) return;
  child(page, "h2", title);
  const list = child(page, "ul");
  for (const item of items) child(list, "li", item);
}

function inventoryOf(page, inventory) {
  const rows = Object.entries(inventory).map(([what, { source, output, rules }]) => [
    what.replaceAll("_", " "), `source ${source}, output ${output}${rules && Object.keys(rules).length ? `: ${told(rules)}` : ""}`,
  ]);
  tableOf(page, "What both programs hold", rows);
}
