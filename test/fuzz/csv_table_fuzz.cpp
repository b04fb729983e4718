// SPDX-FileCopyrightText: 2026 The edgesplat authors
// SPDX-License-Identifier: Apache-2.0
#include "tools/report/csv_table.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

/// Whatever the bytes are: every column is as long as the table, or there is an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  const auto table = edgesplat::report::CsvTable::parse(text, "fuzz.csv");
  if (!table) return 0;
  for (const std::string& name : table->names_ending("")) {
    if (table->rows() > 0 && table->numbers(name).size() < table->rows()) std::abort();
  }
  return 0;
}
