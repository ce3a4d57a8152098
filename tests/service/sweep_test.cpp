// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps through the real processes: what a row gives is what its load gives alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

using anticrack::testing::TemporaryFolder;
using ::testing::HasSubstr;

/// A line of --csv by the names of its columns.
using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) {
    fields.push_back(field);
  }
  return fields;
}

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream stream(read_file(csv));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = fields_of(line);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> fields = fields_of(line);
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < names.size() && i < fields.size(); ++i) {
      row[names[i]] = fields[i];
    }
  }
  return rows;
}

google::protobuf::Map<std::string, google::protobuf::Value> answer(
    const google::protobuf::Struct& document, int load) {
  return document.fields().at("answers").list_value().values(load).struct_value().fields();
}

/// Energy, A and contact length of a row are those of a load case of `run --json`.
void expect_same(const Row& row, const google::protobuf::Struct& document, int load) {
  const auto alone = answer(document, load);
  const auto& inclusion = alone.at("inclusions").list_value().values(0).struct_value().fields();
  const double energy = alone.at("energy_mesh").number_value();  // rows have no bounds
  EXPECT_NEAR(std::stod(row.at("energy")), energy, 1e-9 * std::abs(energy));
  EXPECT_NEAR(std::stod(row.at("A")), inclusion.at("A_mesh").number_value(), 1e-9);
  EXPECT_NEAR(std::stod(row.at("contact_length")), alone.at("contact_length").number_value(), 1e-9);
  EXPECT_EQ(row.at("status"), alone.at("status").string_value());
}

std::vector<std::string> ratio_sweep() {
  return {"sweep", example("load-ratio.toml"), "--coefficients", example("load-ratio.csv")};
}

std::vector<std::string> with(std::vector<std::string> arguments,
                              const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Sweep, CanBeSubmittedWatchedAndFetchedSeparately) {
  const Server server;
  const TemporaryFolder folder;
  const Ended submit = server.client(with(ratio_sweep(), {"--detach", "--json"}));
  ASSERT_EQ(submit.code, 0) << submit.output << submit.error;
  const std::string name = parse_json(submit.output).fields().at("name").string_value();

  const Ended watch = server.client({"job", "watch", name});
  EXPECT_EQ(watch.code, 0) << watch.output << watch.error;
  EXPECT_THAT(watch.output, HasSubstr("sweep of 81 rows: 81 converged"));
  EXPECT_THAT(server.client({"job", "list"}).output, HasSubstr("81/81 rows"));

  const Ended fetch = server.client({"job", "fetch", name, "-o", folder / "r.h5"});
  EXPECT_EQ(fetch.code, 0) << fetch.error;
  EXPECT_THAT(fetch.output, HasSubstr("81 converged"));
}

TEST(Sweep, TakesAMatrixThatIsTooLargeForARequest) {
  const Server server;
  const TemporaryFolder folder;
  constexpr int loads = 64;
  constexpr int rows = 2100;  // 8 bytes each: a little more than 1 MiB
  std::string cases = read_file(example("load-ratio.toml"));
  cases.resize(cases.find("[[load]]"));
  for (int i = 0; i < loads; ++i) {
    cases += "[[load]]\nname = \"load " + std::to_string(i) + "\"\nf = \"x * y + " +
             std::to_string(i) + " * (x - y)\"\n";
  }
  std::string matrix;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < loads; ++i) {
      matrix += (i == 0 ? "" : ",") + std::to_string((row * 7 + i * 13) % 11 - 5);
    }
    matrix += '\n';
  }
  const Ended sweep = server.client({"sweep", write_file(folder, "many.toml", cases),
                                     "--coefficients", write_file(folder, "many.csv", matrix),
                                     "--set", "mesh.preset=uniform", "--set", "mesh.size=0.1", "-o",
                                     folder / "many.h5", "--csv", folder / "out.csv"});
  ASSERT_EQ(sweep.code, 0) << sweep.output << sweep.error;
  const std::vector<Row> answers = rows_of(folder / "out.csv");
  ASSERT_EQ(answers.size(), rows);
  // The coefficients have a period, so the answers have it too, wherever the row was solved.
  for (const std::size_t row : {std::size_t{0}, std::size_t{500}, std::size_t{2000}}) {
    EXPECT_NEAR(std::stod(answers[row].at("energy")), std::stod(answers[row + 11].at("energy")),
                1e-9 * std::abs(std::stod(answers[row].at("energy"))));
  }
}

/// A dataset /f of (rows, columns): row k is values[k] everywhere.
std::string write_matrix(const std::string& file, const std::vector<double>& values,
                         std::size_t columns) {
  std::vector<double> matrix;
  for (const double value : values) {
    matrix.insert(matrix.end(), columns, value);
  }
  const hid_t id = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const std::vector<hsize_t> shape{values.size(), columns};
  const hid_t space = H5Screate_simple(2, shape.data(), nullptr);
  const hid_t set =
      H5Dcreate2(id, "f", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, matrix.data());
  H5Dclose(set);
  H5Sclose(space);
  H5Fclose(id);
  return file + ":/f";
}

TEST(Sweep, TakesForcesOnTheNodes) {
  const Server server;
  const TemporaryFolder folder;
  const Ended alone = server.client({"run", example("load-ratio.toml"), "--set",
                                     "load=[{name='up', f=1}, {name='down', f=-2}]", "-o",
                                     folder / "alone.h5", "--json"});
  ASSERT_EQ(alone.code, 0) << alone.output << alone.error;
  const std::string mesh = parse_json(alone.output)
                               .fields()
                               .at("mesh")
                               .struct_value()
                               .fields()
                               .at("name")
                               .string_value();
  const Ended shown = server.client({"mesh", "show", mesh, "--json"});
  ASSERT_EQ(shown.code, 0) << shown.error;
  const auto nodes = static_cast<std::size_t>(
      std::stoull(parse_json(shown.output).fields().at("node_count").string_value()));

  const std::vector<std::string> sweep{
      "sweep",  example("load-ratio.toml"), "--csv", folder / "f.csv", "-o", folder / "f.h5",
      "--nodal"};
  const Ended wrong =
      server.client(with(sweep, {write_matrix(folder / "wrong.h5", {1}, nodes - 1)}));
  EXPECT_EQ(wrong.code, 2) << wrong.output;
  EXPECT_THAT(wrong.error, HasSubstr("columns, the mesh " + std::to_string(nodes) + " nodes"));
  EXPECT_EQ(server.jobs().size(), 1U) << "the run before";

  const Ended run = server.client(with(sweep, {write_matrix(folder / "f2.h5", {1, -2}, nodes)}));
  ASSERT_EQ(run.code, 0) << run.output << run.error;
  const std::vector<Row> rows = rows_of(folder / "f.csv");
  ASSERT_EQ(rows.size(), 2U);
  expect_same(rows[0], parse_json(alone.output), 0);
  expect_same(rows[1], parse_json(alone.output), 1);
}

}  // namespace
}  // namespace anticrack::service_test
