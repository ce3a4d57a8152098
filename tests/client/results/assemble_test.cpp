// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>
#include <memory>

#include "support/sample_result.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::sample_pair;
using anticrack::testing::sample_result;
using anticrack::testing::with_stages;
using ::testing::HasSubstr;

/// The two blocks a server would send for a result, with bytes of their own.
class Blocks {
 public:
  explicit Blocks(const Result& result) {
    add(mesh, "nodes", result.mesh.xy, 2);
    add(mesh, "triangles", result.mesh.triangles, 3);
    add(mesh, "subdomain", result.mesh.subdomain);
    add(mesh, "boundary", result.mesh.boundary, 2);
    for (std::size_t i = 0; i < result.interfaces.size(); ++i) {
      const Interface& interface = result.interfaces[i];
      const std::string at = "interfaces/" + std::to_string(i) + "/";
      add(mesh, at + "edge_kind", numbers_of(interface.edges.kind));
      add(mesh, at + "edge_inclusion", interface.edges.inclusion);
      add(answer, at + "s", interface.s);
      add(answer, at + "x", interface.x);
      add(answer, at + "y", interface.y);
      add(answer, at + "kind", numbers_of(interface.kind));
    }
    for (std::size_t i = 0; i < result.loads.size(); ++i) {
      add_load("loads/" + std::to_string(i) + "/", result.loads[i]);
    }
    for (std::size_t i = 0; i < result.loads[0].fields.size(); ++i) {
      const std::string at = "fields/" + std::to_string(i);
      add(answer, at + "/nodes", result.loads[0].fields[i].nodes);
      add(answer, at + "/triangles", result.loads[0].fields[i].triangles, 3);
    }
  }

  ArrayView& array(const std::string& name) {
    for (auto* block : {&mesh, &answer}) {
      for (ArrayView& each : *block) {
        if (each.name == name) return each;
      }
    }
    throw std::out_of_range(name);
  }

  void drop(const std::string& prefix) {
    for (auto* block : {&mesh, &answer}) {
      std::erase_if(*block, [&](const ArrayView& each) { return each.name.starts_with(prefix); });
    }
  }

  template <typename T>
  void overwrite(const std::string& name, std::size_t index, T value) {
    const auto bytes = array(name).bytes;
    for (auto& stored : _storage) {
      if (stored->data() == bytes.data()) {
        std::memcpy(stored->data() + index * sizeof(T), &value, sizeof(T));
      }
    }
  }

  std::vector<ArrayView> mesh, answer;

 private:
  static std::vector<std::int32_t> numbers_of(const std::vector<Kind>& kinds) {
    std::vector<std::int32_t> numbers;
    for (const Kind kind : kinds) numbers.push_back(static_cast<std::int32_t>(kind));
    return numbers;
  }

  template <typename T>
  void add(std::vector<ArrayView>& block, const std::string& name, const std::vector<T>& values,
           std::uint64_t columns = 0) {
    auto bytes = std::make_unique<std::vector<std::byte>>(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes->data(), values.data(), bytes->size());
    std::vector<std::uint64_t> shape{values.size()};
    if (columns != 0) shape = {values.size() / columns, columns};
    const auto type = sizeof(T) == 8 ? ArrayView::Type::float64 : ArrayView::Type::int32;
    block.push_back({name, type, shape, *bytes});
    _storage.push_back(std::move(bytes));
  }

  void add_load(const std::string& at, const Load& load) {
    for (std::size_t i = 0; i < load.traces.size(); ++i) {
      const std::string trace = at + "traces/" + std::to_string(i) + "/";
      add(answer, trace + "u_minus", load.traces[i].u_minus);
      add(answer, trace + "u_plus", load.traces[i].u_plus);
      add(answer, trace + "jump", load.traces[i].jump);
      add(answer, trace + "pressure", load.traces[i].pressure);
      add(answer, trace + "contact", load.traces[i].contact);
    }
    if (!load.indicator.empty()) add(answer, at + "indicator", load.indicator);
    const History& history = load.history;
    add(answer, at + "history/iteration", history.iteration);
    add(answer, at + "history/criterion", history.criterion);
    add(answer, at + "history/energy", history.energy);
    add(answer, at + "history/contact_count", history.contact_count);
    add(answer, at + "history/kkt_equilibrium", history.kkt.equilibrium);
    add(answer, at + "history/kkt_gap", history.kkt.gap);
    add(answer, at + "history/kkt_sign", history.kkt.sign);
    add(answer, at + "history/kkt_complementarity", history.kkt.complementarity);
    for (std::size_t i = 0; i < load.fields.size(); ++i) {
      add(answer, at + "fields/" + std::to_string(i), load.fields[i].u);
    }
  }

  std::vector<std::unique_ptr<std::vector<std::byte>>> _storage;
};

/// A result without its arrays: what the messages say.
Result answers_of(Result result) {
  const std::vector<std::string> subdomains = result.mesh.subdomains;
  const std::vector<double> tension = result.mesh.tension;
  const std::vector<std::string> inclusions = result.mesh.inclusions;
  result.mesh = {};
  result.mesh.subdomains = subdomains;
  result.mesh.tension = tension;
  result.mesh.inclusions = inclusions;
  for (Interface& interface : result.interfaces) interface = {interface.name, {}, {}, {}, {}, {}};
  for (Load& load : result.loads) {
    load.traces.clear();
    load.history = {};
    load.fields.clear();
    load.indicator.clear();
  }
  return result;
}

TEST(Assemble, gives_back_what_the_blocks_hold) {
  const Result result = sample_pair(4);
  const Blocks blocks(result);
  const Result built = assemble(answers_of(result), blocks.mesh, blocks.answer);
  EXPECT_EQ(built.mesh.xy, result.mesh.xy);
  EXPECT_EQ(built.mesh.triangles, result.mesh.triangles);
  EXPECT_EQ(built.mesh.boundary, result.mesh.boundary);
  EXPECT_EQ(built.interfaces[0].kind, result.interfaces[0].kind);
  EXPECT_EQ(built.interfaces[0].edges.kind, result.interfaces[0].edges.kind);
  EXPECT_EQ(built.interfaces[0].edges.inclusion, result.interfaces[0].edges.inclusion);
  EXPECT_EQ(built.loads[1].traces[0].jump, result.loads[1].traces[0].jump);
  EXPECT_EQ(built.loads[1].traces[0].contact, result.loads[1].traces[0].contact);
  EXPECT_EQ(built.loads[0].history.criterion, result.loads[0].history.criterion);
  EXPECT_EQ(built.loads[0].fields[1].u, result.loads[0].fields[1].u);
  EXPECT_EQ(built.loads[0].fields[1].nodes, result.loads[0].fields[1].nodes);
  EXPECT_EQ(built.loads[0].name(), "opening");
}

TEST(Assemble, keeps_stages_and_adds_indicators) {
  Result result = with_stages(sample_result(4));
  result.loads[1].indicator.clear();
  const Blocks blocks(result);
  const Result built = assemble(answers_of(result), blocks.mesh, blocks.answer);
  EXPECT_EQ(built.loads[0].indicator, result.loads[0].indicator);
  EXPECT_TRUE(built.loads[1].indicator.empty());
  EXPECT_EQ(built.loads[1].stages.size(), 5U);
}

TEST(Assemble, a_load_that_failed_needs_no_arrays) {
  Result result = sample_result(4);
  Blocks blocks(result);
  result.loads[0].answer.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  blocks.drop("loads/0/");
  const Result built = assemble(answers_of(result), blocks.mesh, blocks.answer);
  EXPECT_TRUE(built.loads[0].traces.empty());
  EXPECT_FALSE(built.loads[1].traces.empty());
}

TEST(Assemble, passes_over_arrays_of_a_newer_server) {
  const Result result = sample_result(4);
  Blocks blocks(result);
  blocks.answer.push_back({"loads/0/stress", ArrayView::Type::float64, {0}, {}});
  EXPECT_NO_THROW(assemble(answers_of(result), blocks.mesh, blocks.answer));
}

struct Lie {
  std::string name;
  std::function<void(Blocks&)> tell;
  std::string complaint;
};

class Lies : public ::testing::TestWithParam<Lie> {};

TEST_P(Lies, are_refused) {
  const Result result = sample_result(4);
  Blocks blocks(result);
  GetParam().tell(blocks);
  try {
    assemble(answers_of(result), blocks.mesh, blocks.answer);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().complaint));
    EXPECT_THAT(error.cure(), HasSubstr("version"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Assemble, Lies,
    ::testing::Values(
        Lie{"missing", [](Blocks& b) { b.drop("loads/0/traces/0/jump"); },
            "loads/0/traces/0/jump is missing"},
        Lie{"missing_all_traces", [](Blocks& b) { b.drop("loads/0/traces"); }, "is missing"},
        Lie{"missing_field_nodes", [](Blocks& b) { b.drop("fields/1/nodes"); },
            "fields/1/nodes is missing"},
        Lie{"wrong_type", [](Blocks& b) { b.array("triangles").type = ArrayView::Type::float64; },
            "triangles is float64, not int32"},
        Lie{"wrong_rank", [](Blocks& b) { b.array("nodes").shape = {162}; }, "shape (162)"},
        Lie{"wrong_columns",
            [](Blocks& b) {
              b.array("nodes").shape = {54, 3};
            },
            "shape (54,3)"},
        Lie{"shape_and_bytes_disagree",
            [](Blocks& b) {
              b.array("nodes").shape = {82, 2};
            },
            "comes with 1296 bytes"},
        Lie{"shape_that_overflows",
            [](Blocks& b) {
              b.array("nodes").shape = {std::uint64_t{1} << 60, 2};
            },
            "impossible"},
        Lie{"twice", [](Blocks& b) { b.answer.push_back(b.answer.back()); }, "twice"},
        Lie{"triangle_out_of_range",
            [](Blocks& b) { b.overwrite<std::int32_t>("triangles", 5, 81); },
            "mesh.triangles[5] is 81"},
        Lie{"negative_node", [](Blocks& b) { b.overwrite<std::int32_t>("boundary", 0, -1); },
            "mesh.boundary[0] is -1"},
        Lie{"subdomain_out_of_range",
            [](Blocks& b) { b.overwrite<std::int32_t>("subdomain", 3, 2); }, "mesh.subdomain[3]"},
        Lie{"field_node_out_of_range",
            [](Blocks& b) { b.overwrite<std::int32_t>("fields/0/nodes", 1, 9999); },
            "loads[0].fields[0].nodes[1]"},
        Lie{"corner_out_of_range",
            [](Blocks& b) { b.overwrite<std::int32_t>("fields/1/triangles", 2, 45); },
            "loads[0].fields[1].triangles[2] is 45"},
        Lie{"triangles_of_another_number",
            [](Blocks& b) {
              auto& triangles = b.array("fields/1/triangles");
              triangles.shape = {63, 3};
              triangles.bytes = triangles.bytes.first(63 * 12);
            },
            "fields[1].triangles has 189 entries for 192 corners"},
        Lie{"missing_triangles", [](Blocks& b) { b.drop("fields/0/triangles"); },
            "fields/0/triangles is missing"},
        Lie{"bonded_without_inclusion",
            [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/edge_inclusion", 3, -1); },
            "interfaces[0].edge_inclusion[3] is -1, there are 1 inclusions"},
        Lie{"kind_unknown", [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/kind", 2, 7); },
            "interfaces[0].kind[2] is 7"},
        Lie{"missing_inclusions_of_edges", [](Blocks& b) { b.drop("interfaces/0/edge_inclusion"); },
            "interfaces/0/edge_inclusion is missing"},
        Lie{"edge_kind_unknown",
            [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/edge_kind", 3, 0); },
            "interfaces[0].edge_kind[3] is 0"},
        Lie{"edges_of_another_number",
            [](Blocks& b) {
              auto& kind = b.array("interfaces/0/edge_kind");
              kind.shape = {7};
              kind.bytes = kind.bytes.first(28);
            },
            "interfaces[0].edge_kind has 7 entries for 8 edges"},
        Lie{"inclusion_out_of_range",
            [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/edge_inclusion", 3, 1); },
            "interfaces[0].edge_inclusion[3] is 1, there are 1 inclusions"},
        Lie{"inclusion_negative",
            [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/edge_inclusion", 3, -2); },
            "interfaces[0].edge_inclusion[3] is -2"},
        Lie{"inclusion_on_glue",
            [](Blocks& b) { b.overwrite<std::int32_t>("interfaces/0/edge_inclusion", 0, 0); },
            "interfaces[0].edge_inclusion[0] is 0, but its edge_kind is that of no inclusion"},
        Lie{"contact_not_a_flag",
            [](Blocks& b) { b.overwrite<std::int32_t>("loads/1/traces/0/contact", 0, 2); },
            "contact[0] is 2"},
        Lie{"coordinate_not_finite",
            [](Blocks& b) { b.overwrite("nodes", 7, std::numeric_limits<double>::quiet_NaN()); },
            "mesh.nodes[7] is not finite"},
        Lie{"arc_length_goes_back", [](Blocks& b) { b.overwrite("interfaces/0/s", 4, 0.1); },
            "does not increase"},
        Lie{"trace_of_another_length",
            [](Blocks& b) {
              auto& jump = b.array("loads/0/traces/0/jump");
              jump.shape = {8};
              jump.bytes = jump.bytes.first(64);
            },
            "8 entries for 9 nodes"},
        Lie{"history_of_another_length",
            [](Blocks& b) {
              auto& energy = b.array("loads/0/history/energy");
              energy.shape = {1};
              energy.bytes = energy.bytes.first(8);
            },
            "1 entries for 180 iterations"}),
    [](const auto& each) { return each.param.name; });

TEST(View, finds_an_array_at_any_alignment) {
  std::vector<std::byte> block(21);
  const double value = 2.5;
  std::memcpy(block.data() + 5, &value, 8);
  const auto seen = view("x", ArrayView::Type::float64, {2}, 5, block);
  EXPECT_EQ(seen.bytes.size(), 16u);
  double found = 0;
  std::memcpy(&found, seen.bytes.data(), 8);
  EXPECT_EQ(found, value);
}

TEST(View, refuses_what_lies_outside_the_block) {
  const std::vector<std::byte> block(16);
  EXPECT_NO_THROW(view("x", ArrayView::Type::int32, {4}, 0, block));
  EXPECT_NO_THROW(view("x", ArrayView::Type::int32, {0}, 16, block));
  EXPECT_THROW(view("x", ArrayView::Type::int32, {4}, 1, block), Error);
  EXPECT_THROW(view("x", ArrayView::Type::int32, {1}, 17, block), Error);
  EXPECT_THROW(view("x", ArrayView::Type::int32, {1}, ~std::uint64_t{0}, block), Error);
  EXPECT_THROW(view("x", ArrayView::Type::float64, {std::uint64_t{1} << 61}, 0, block), Error);
}

}  // namespace
}  // namespace anticrack::results
