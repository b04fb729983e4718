// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/html_page.hpp"

#include "tools/report/html_text.hpp"

namespace edgesplat::report {
namespace {

constexpr std::string_view kStyle = R"(
:root{color-scheme:light dark;--page:#fff;--text:#1b1f24;--soft:#5a6570;--line:#d5dae0;--card:#f4f6f8}
@media(prefers-color-scheme:dark){:root{--page:#14181d;--text:#e6e9ec;--soft:#9aa5b0;--line:#38414b;--card:#1e242b}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1120px;padding:1rem;background:var(--page);color:var(--text);
 font:16px/1.45 system-ui,-apple-system,"Segoe UI",Roboto,sans-serif}
h1{font-size:1.5rem;margin:.4rem 0}h2{font-size:1.15rem;margin:2rem 0 .6rem;border-bottom:1px solid var(--line)}
p{margin:.5rem 0;color:var(--soft)}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(210px,1fr));gap:.6rem}
.card{background:var(--card);border-radius:8px;padding:.6rem .8rem}
.card span{display:block;color:var(--soft);font-size:.8rem}.card b{font-size:1.1rem;font-weight:600}
.grid{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,420px),1fr));gap:.8rem;align-items:start}
.grid.thirds{grid-template-columns:repeat(auto-fit,minmax(min(100%,320px),1fr))}
.grid.quarters{grid-template-columns:repeat(auto-fit,minmax(min(100%,230px),1fr))}
figure{margin:0}figure img{width:100%;display:block;border-radius:6px}figcaption{font-size:.8rem;color:var(--soft)}
svg{width:100%;height:auto;display:block;font:12px system-ui,sans-serif}
svg text{fill:var(--text)}svg .title{font-weight:600;font-size:13px}
svg .axis{fill:none;stroke:var(--soft)}svg .grid{stroke:var(--line);stroke-width:.7;stroke-opacity:.8}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-size:.9rem}
th,td{padding:.25rem .9rem .25rem 0;text-align:right;border-bottom:1px solid var(--line);white-space:nowrap}
th:first-child,td:first-child{text-align:left}th{color:var(--soft);font-weight:500}
details{margin:.4rem 0}summary{cursor:pointer}pre{background:var(--card);padding:.6rem;overflow-x:auto;font-size:.8rem}
)";

std::string grid_of(std::string_view classes, const std::vector<std::string>& pieces) {
  std::string html = "<div class=\"" + std::string(classes) + "\">\n";
  for (const std::string& piece : pieces) html += "<div>" + piece + "</div>\n";
  return html + "</div>\n";
}

}  // namespace

std::string html_page(std::string_view title, std::string_view body) {
  std::string page = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n";
  page += R"(<meta name="viewport" content="width=device-width,initial-scale=1">)";
  page += "\n<title>" + escape_html(title) + "</title>\n<style>" + std::string(kStyle) +
          "</style></head>\n<body>\n";
  page += "<h1>" + escape_html(title) + "</h1>\n" + std::string(body) + "</body></html>\n";
  return page;
}

std::string html_section(std::string_view heading, std::string_view body) {
  return "<section><h2>" + escape_html(heading) + "</h2>\n" + std::string(body) + "</section>\n";
}

std::string html_paragraph(std::string_view text) {
  return "<p>" + escape_html(text) + "</p>\n";
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table>\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string begin = i == 0 ? "<th>" : "<td>";
    const std::string end = i == 0 ? "</th>" : "</td>";
    html += "<tr>";
    for (const std::string& text : rows[i]) html.append(begin).append(escape_html(text)).append(end);
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_grid(const std::vector<std::string>& pieces) {
  return grid_of("grid", pieces);
}

std::string html_picture_grid(const std::vector<std::string>& pieces) {
  return grid_of(pieces.size() % 4 == 0 ? "grid quarters" : "grid thirds", pieces);
}

std::string html_picture(std::string_view uri, std::string_view caption) {
  const std::string text = escape_html(caption);
  return "<figure><img alt=\"" + text + "\" src=\"" + std::string(uri) + "\"><figcaption>" + text +
         "</figcaption></figure>\n";
}

std::string html_details(std::string_view heading, std::string_view text) {
  return "<details><summary>" + escape_html(heading) + "</summary><pre>" + escape_html(text) +
         "</pre></details>\n";
}

std::string html_figure_card(std::string_view label, std::string_view value) {
  return "<div class=\"card\"><span>" + escape_html(label) + "</span><b>" + escape_html(value) +
         "</b></div>\n";
}

}  // namespace edgesplat::report
