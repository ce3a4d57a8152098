// SPDX-License-Identifier: GPL-3.0-or-later
//
// The table of client/RESULT.md is what the tables say, and a file holds what it lists.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "client/sample_sweep.hpp"
#include "results/arrays.hpp"
#include "results/entries.hpp"
#include "results/file.hpp"
#include "results/tables.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::results {
namespace {

/// What entries are, unless float64.
std::string type_text(ValueType type) {
  return type == ValueType::float64 ? ""
         : type == ValueType::text  ? " text"
                                    : std::string(" ") + name_of(type);
}

/// "`x`, `y` (k): coordinates; ...". A row that says nothing has the words of the next that does.
/// Members of records have no shape.
template <class Table>
std::string entries(const Table& table, bool records = false) {
  std::string text;
  bool joined = false;
  const auto add = [&](const auto& row) {
    text += (joined ? ", `" : text.empty() ? "`" : "; `") + std::string(row.name) + "`";
    joined = row.what.empty();
    if (joined) return;
    if constexpr (requires { row.type; })
      text += (records ? "" : " (" + std::string(row.shape) + ")") + type_text(row.type);
    text += ": " + std::string(row.what);
    if (!row.unit.empty()) text += " [" + std::string(row.unit) + "]";
  };
  std::apply([&](const auto&... rows) { (add(rows), ...); }, table);
  return text;
}

/// Of the values of a message, with the comments of its fields.
std::string entries(const google::protobuf::Descriptor& type) {
  std::string text;
  for (const Entry& entry : entries_of(type)) {
    text += (text.empty() ? "`" : "; `") + entry.name + "`" + type_text(entry.type) + ": " +
            std::regex_replace(entry.meaning, std::regex("\\|"), "\\|");
    if (!entry.unit.empty()) text += " [" + entry.unit + "]";
  }
  return text;
}

std::string line(const std::string& where, const std::string& what) {
  return "| `" + where + "` | " + what + " |\n";
}

std::string result_table() {
  const std::string values = "attributes ";
  return "| where | what |\n|---|---|\n" +
         line("/", values + "`format`; " + entries(tables::result)) +
         line("/",
              "`meanings` (numbers,4) text: of each number of the solver, mesh, loads, "
              "stages and sweep, and of their lists: where it is, its name, unit and meaning") +
         line("/units", values + entries(*v1::Units::descriptor())) +
         line("/solver", values + entries(*v1::Solver::descriptor())) +
         line("/mesh", values + entries(*v1::Mesh::descriptor())) +
         line("/mesh", entries(tables::mesh) +
                           "; `inclusions` (i) text: names; `warnings` (w) text: what an import "
                           "repaired or assumed") +
         line("/mesh/subdomains", entries(*v1::SubdomainInfo::descriptor())) +
         line("/mesh/interfaces", entries(*v1::InterfaceInfo::descriptor())) +
         line("/mesh/tips", entries(*v1::TipInfo::descriptor())) +
         line("/interfaces/I", entries(tables::interface)) +
         line("/loads/LOAD",
              values + "`index`: from 0; " + entries(*v1::LoadCaseAnswer::descriptor())) +
         line("/loads/LOAD",
              "`warnings` (w) text: e.g. of a load not integrated as exactly as "
              "asked; `growth_notes` (g) text: with growth, jumps, what snaps and why it ends; " +
                  entries(tables::load)) +
         line("/loads/LOAD/stages", "with an accuracy: " + entries(*v1::Stage::descriptor()) +
                                        "; " + entries(*v1::StageAnswer::descriptor())) +
         line("/loads/LOAD/inclusions", entries(*v1::InclusionAnswer::descriptor())) +
         line("/loads/LOAD/tips", entries(*v1::Tip::descriptor())) +
         line("/loads/LOAD/boundary", entries(*v1::BoundaryAnswer::descriptor())) +
         line("/loads/LOAD/probes", entries(*v1::ProbeAnswer::descriptor())) +
         line("/loads/LOAD/growth", entries(*v1::GrowthRow::descriptor())) +
         line("/loads/LOAD/contact_intervals", entries(*v1::ContactInterval::descriptor())) +
         line("/loads/LOAD/traces/I", entries(tables::trace)) +
         line("/loads/LOAD/history", entries(tables::history, true)) +
         line("/loads/LOAD/fields/D",
              "when asked for: " + entries(tables::subdomain) + "; " + entries(tables::field)) +
         line("/sweep", "of a sweep: " + values + "`description`; " + entries(tables::sweep) +
                            "; " + entries(*v1::SweepAnswer::descriptor())) +
         line("/sweep", "`warnings` (w) text: about the loads; " + entries(tables::columns));
}

TEST(ResultTable, has_the_table_of_the_result_file) {
  std::ifstream file(ANTICRACK_RESULT_TABLE);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, ::testing::EndsWith("\n" + result_table()))
      << "put this table into client/RESULT.md:\n"
      << result_table();
}

/// Where in the table an object of a file is: "/loads/row-3/traces/0" is "/loads/LOAD/traces/I".
std::string where(const std::string& path) {
  std::istringstream parts(path);
  std::string at, part, parent;
  while (std::getline(parts, part, '/')) {
    if (part.empty()) continue;
    at += "/" + (parent == "loads"                              ? "LOAD"
                 : parent == "fields"                           ? "D"
                 : parent == "interfaces" || parent == "traces" ? "I"
                                                                : part);
    parent = part;
  }
  return at.empty() ? "/" : at;
}

using Names = std::set<std::pair<std::string, std::string>>;

herr_t add_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

/// A group's attributes, or the members of a dataset's records.
herr_t add_object(hid_t file, const char* path, const H5L_info_t*, void* names) {
  const std::string full = std::string("/") + (std::string(path) == "." ? "" : path);
  Names& all = *static_cast<Names*>(names);
  const hid_t id = H5Oopen(file, path, H5P_DEFAULT);
  if (H5Iget_type(id) == H5I_DATASET) {
    const std::size_t slash = full.rfind('/');
    const hid_t type = H5Dget_type(id);
    if (H5Tget_class(type) != H5T_COMPOUND)
      all.emplace(where(full.substr(0, slash)), full.substr(slash + 1));
    else
      for (int i = 0; i < H5Tget_nmembers(type); ++i) {
        char* const name = H5Tget_member_name(type, static_cast<unsigned>(i));
        all.emplace(where(full), name);
        H5free_memory(name);
      }
    H5Tclose(type);
  } else {
    std::vector<std::string> attributes;
    H5Aiterate2(id, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute, &attributes);
    for (const std::string& attribute : attributes) all.emplace(where(full), attribute);
  }
  H5Oclose(id);
  return 0;
}

void add_names(const Result& result, Names& names) {
  const anticrack::testing::TemporaryFolder folder;
  write(folder / "a.h5", result);
  const hid_t file = H5Fopen((folder / "a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  add_object(file, ".", nullptr, &names);
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, add_object, &names);  // all names of an empty list
  H5Fclose(file);
}

TEST(ResultTable, lists_what_a_file_holds_and_nothing_else) {
  Names held;
  add_names(anticrack::testing::with_stages(anticrack::testing::sample_result(2)), held);
  add_names(anticrack::testing::tilting_sweep(5), held);
  Result sweep = anticrack::testing::bounded_sweep(5);
  for (const char* of_tips : {"intensity", "energy_release_rate", "energy_release_rate_spread"})
    sweep.sweep->columns[of_tips] = array_of(std::vector<double>(10, 0.5), {2});
  add_names(sweep, held);
  Names listed;
  std::istringstream lines(result_table());
  for (std::string text; std::getline(lines, text);) {
    const std::size_t end = text.find('`', 3);
    if (!text.starts_with("| `")) continue;
    const std::string at = text.substr(3, end - 3);
    // A name is what stands in `` at the start of an entry.
    for (std::size_t i = text.find('`', end + 1); i != std::string::npos;) {
      const std::size_t close = text.find('`', i + 1);
      const std::string before = text.substr(0, i);
      if (before.ends_with("; ") || before.ends_with("`, ") || before.ends_with("| ") ||
          before.ends_with("accuracy: ") || before.ends_with("asked for: ") ||
          before.ends_with("attributes ") || before.ends_with("attribute ")) {
        listed.emplace(at, text.substr(i + 1, close - i - 1));
      }
      i = text.find('`', close + 1);
    }
  }
  EXPECT_EQ(listed, held);
}

}  // namespace
}  // namespace anticrack::results
