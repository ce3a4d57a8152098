// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "client/sample_sweep.hpp"
#include "support/block_maker.hpp"

namespace anticrack::results {
namespace {

using anticrack::testing::BlockMaker;
using anticrack::testing::same;
using anticrack::testing::sample_result;
using anticrack::testing::with_stages;
using ::testing::HasSubstr;

/// The two blocks a server would send for a result, to be spoilt.
struct Blocks : anticrack::testing::ResultBlocks {
  using ResultBlocks::ResultBlocks;

  v1::ArrayLayout& array(const std::string& name) {
    for (auto* block : {&mesh, &answer})
      for (v1::ArrayLayout& each : *block->layout.mutable_arrays())
        if (each.name() == name) return each;
    throw std::out_of_range(name);
  }

  void reshape(const std::string& name, const std::vector<std::uint64_t>& shape) {
    array(name).mutable_shape()->Assign(shape.begin(), shape.end());
  }

  void drop(const std::string& prefix) {
    for (auto* block : {&mesh, &answer}) {
      auto& arrays = *block->layout.mutable_arrays();
      const auto kept = std::remove_if(arrays.begin(), arrays.end(), [&](const auto& each) {
        return each.name().starts_with(prefix);
      });
      arrays.erase(kept, arrays.end());
    }
  }
};

Result assembled(Result answers, const Blocks& blocks) {
  const auto view = [](const BlockMaker& block) {
    return BlockView{block.layout, std::make_shared<const std::vector<std::byte>>(block.bytes)};
  };
  answers.arrays.clear();  // what is left is what the messages say
  return assemble(std::move(answers), view(blocks.mesh), view(blocks.answer));
}

TEST(Assemble, gives_back_what_the_blocks_hold) {
  const Result result = with_stages(sample_result(4));
  const Result built = assembled(result, Blocks(result));
  EXPECT_TRUE(same(built.arrays, result.arrays));
  EXPECT_EQ(built.loads[0].name(), "opening");
  EXPECT_EQ(built.loads[1].stages.size(), 5U);
}

TEST(Assemble, a_load_that_failed_needs_no_arrays) {
  Result result = sample_result(4);
  Blocks blocks(result);
  result.loads[0].answer.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  blocks.drop("loads/0/");
  const Result built = assembled(result, blocks);
  EXPECT_FALSE(built.arrays.contains("loads/opening/traces/0/jump"));
  EXPECT_TRUE(built.arrays.contains("loads/partly closed/traces/0/jump"));
}

TEST(Assemble, passes_over_arrays_of_a_newer_server) {
  const Result result = sample_result(4);
  Blocks blocks(result);
  blocks.answer.add("loads/0/stress", std::vector<double>{1});
  blocks.answer.layout.mutable_arrays()->rbegin()->set_type(v1::ArrayLayout::TYPE_UNSPECIFIED);
  EXPECT_NO_THROW(assembled(result, blocks));
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
    assembled(result, blocks);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().complaint));
    EXPECT_THAT(error.what(), HasSubstr("compare their versions"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Assemble, Lies,
    ::testing::Values(
        Lie{"missing", [](Blocks& b) { b.drop("loads/0/traces/0/jump"); },
            "loads/opening/traces/0/jump is missing"},
        Lie{"missing_all_traces", [](Blocks& b) { b.drop("loads/0/traces"); }, "is missing"},
        Lie{"missing_field_nodes", [](Blocks& b) { b.drop("fields/1/nodes"); },
            "fields/1/nodes is missing"},
        Lie{"wrong_type",
            [](Blocks& b) { b.array("triangles").set_type(v1::ArrayLayout::TYPE_UINT8); },
            "triangles is uint8, not int32"},
        Lie{"wrong_rank", [](Blocks& b) { b.reshape("nodes", {162}); },
            "array mesh/nodes has shape (162), not (n,2)"},
        Lie{"wrong_columns",
            [](Blocks& b) {
              b.reshape("nodes", {54, 3});
            },
            "shape (54,3)"},
        Lie{"shape_beyond_the_block",
            [](Blocks& b) {
              b.reshape("nodes", {1 << 20, 2});
            },
            "array nodes of shape (1048576,2) at byte "},
        Lie{"shape_that_overflows",
            [](Blocks& b) {
              b.reshape("nodes", {std::uint64_t{1} << 60, 2});
            },
            "lies outside"},
        Lie{"rows_of_another_number", [](Blocks& b) { b.reshape("loads/0/traces/0/flux", {8}); },
            "loads/opening/traces/0/flux has shape (8), not (k)"},
        Lie{"offset_between_numbers",
            [](Blocks& b) { b.array("loads/0/traces/0/flux").set_offset(4); }, "lies outside"},
        Lie{"offset_beyond_the_block",
            [](Blocks& b) { b.array("nodes").set_offset(~std::uint64_t{0}); }, "lies outside"},
        Lie{"twice",
            [](Blocks& b) {
              b.answer.add("loads/0/indicator", std::vector<double>{})
                  .add("loads/0/indicator", std::vector<double>{});
            },
            "twice"},
        Lie{"missing_triangles", [](Blocks& b) { b.drop("fields/0/triangles"); },
            "fields/0/triangles is missing"},
        Lie{"missing_inclusions_of_edges", [](Blocks& b) { b.drop("interfaces/0/edge_inclusion"); },
            "interfaces/0/edge_inclusion is missing"}),
    [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace anticrack::results
