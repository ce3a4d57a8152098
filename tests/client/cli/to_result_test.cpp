// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/to_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "client/cli/sample_stages.hpp"
#include "results/result.hpp"
#include "support/block_maker.hpp"

namespace anticrack::cli {
namespace {

using anticrack::testing::BlockMaker;
using ::testing::ElementsAre;
using ::testing::SizeIs;
using Reals = std::vector<double>;
using Integers = std::vector<std::int32_t>;

/// Two triangles, what is said lies on their common edge.
client::Block block_of(const BlockMaker& maker) { return {maker.layout, maker.bytes}; }

client::Block mesh_block(std::int32_t kind, std::int32_t inclusion) {
  return block_of(BlockMaker()
                      .add("nodes", Reals{0, 0, 1, 0, 0, 1, 0, -1}, 2)
                      .add("triangles", Integers{0, 1, 2, 0, 3, 1}, 3)
                      .add("subdomain", Integers{1, 0})
                      .add("boundary", Integers{2, 0}, 2)
                      .add("interfaces/0/nodes", Integers{0, 1})
                      .add("interfaces/0/edge_kind", Integers{kind})
                      .add("interfaces/0/edge_inclusion", Integers{inclusion}));
}

/// Two triangles, an inclusion bonded to both on their common edge, and one iteration.
Fetched fetched() {
  Fetched result;
  result.server.set_version("9.8");
  result.mesh.set_name("meshes/1");
  result.mesh.set_sha256(std::string(64, 'a'));
  result.mesh.set_mesh_seconds(0.25);
  result.mesh.add_subdomains()->set_name("minus");
  v1::SubdomainInfo& plus = *result.mesh.add_subdomains();
  plus.set_name("plus");
  plus.set_tension(2.5);
  plus.mutable_tension_law()->set_along("2 + x");
  result.mesh.add_interfaces()->set_name("sigma");
  result.mesh.add_inclusions("fibre");
  result.job.set_name("jobs/1");
  result.job.mutable_spec()->set_title("A plate");
  result.job.mutable_spec()->add_load_cases()->set_name("one");
  result.job.mutable_spec()->mutable_solver()->mutable_uzawa();
  v1::LoadCaseAnswer& answer = *result.job.mutable_status()->add_answers();
  answer.set_status(v1::LoadCaseAnswer::STATUS_CONVERGED);
  answer.set_iterations(1);
  answer.set_energy(-0.25);
  answer.mutable_solve_time()->set_seconds(1);
  answer.mutable_solve_time()->set_nanos(500'000'000);
  answer.add_inclusions()->set_name("fibre");

  result.mesh_block = mesh_block(3, 0);
  const std::string traces = "loads/0/traces/0/";
  const std::string history = "loads/0/history/";
  BlockMaker maker;
  maker.add("interfaces/0/s", Reals{0, 1}).add("interfaces/0/x", Reals{0, 1});
  maker.add("interfaces/0/y", Reals{0, 0}).add("interfaces/0/kind", Integers{3, 3});
  for (const char* name : {"u_minus", "u_plus", "jump", "pressure", "flux", "force"}) {
    maker.add(traces + name, Reals{0.5, 0.5});
  }
  maker.add(traces + "contact", Integers{0, 0});
  maker.add(history + "iteration", Integers{1}).add(history + "contact_count", Integers{0});
  for (const char* name :
       {"criterion", "energy", "kkt_equilibrium", "kkt_gap", "kkt_sign", "kkt_complementarity"}) {
    maker.add(history + name, Reals{0.5});
  }
  result.result_block = block_of(maker);
  return result;
}

TEST(ToResult, KeepsWhatTheServerSaid) {
  const results::Result result = to_result(fetched());
  EXPECT_EQ(result.title, "A plate");
  EXPECT_EQ(result.server_version, "9.8");
  EXPECT_FALSE(result.client_version.empty());
  EXPECT_EQ(result.mesh.SerializeAsString(), fetched().mesh.SerializeAsString());
  EXPECT_THAT(results::entries_at<double>(result.arrays, "mesh/nodes"), SizeIs(8));
  EXPECT_THAT(results::entries_at<std::int32_t>(result.arrays, "interfaces/0/edge_kind"),
              ElementsAre(3));
  ASSERT_EQ(result.loads.size(), 1U);
  const results::Load& load = result.loads[0];
  EXPECT_EQ(load.name(), "one");
  v1::LoadCaseAnswer sent = fetched().job.status().answers(0);
  sent.set_name("one");
  EXPECT_EQ(load.answer.SerializeAsString(), sent.SerializeAsString());
  EXPECT_THAT(results::entries_at<double>(result.arrays, "loads/one/traces/0/u_plus"),
              ElementsAre(0.5, 0.5));
  EXPECT_THAT(results::entries_at<std::int32_t>(result.arrays, "loads/one/history/iteration"),
              ElementsAre(1));
  EXPECT_EQ(results::solve_seconds(result), 1.5);
}

TEST(ToResult, KeepsTheStagesThatEnded) {
  Fetched staged = fetched();
  EXPECT_EQ(mesh_of(staged.job), staged.job.spec().mesh());
  *staged.job.mutable_status()->add_stages() = stage(1, 900, 0.02, 2);
  *staged.job.mutable_status()->add_stages() = stage(2, 5000, 0.01);
  staged.job.mutable_status()->mutable_stages(1)->mutable_answers(0)->clear_energy_lower();
  staged.job.mutable_status()->mutable_stages(1)->mutable_answers(0)->clear_displacement_error();
  staged.job.mutable_status()->add_stages()->set_mesh("meshes/3");  // was stopped
  staged.job.mutable_status()->set_not_reached("too few triangles");
  EXPECT_EQ(mesh_of(staged.job), "meshes/2");
  const results::Result result = to_result(staged);
  EXPECT_EQ(result.not_reached, "too few triangles");
  const std::vector<v1::Stage>& stages = result.loads.at(0).stages;
  ASSERT_EQ(stages.size(), 2U);
  EXPECT_EQ(stages[0].triangles(), 900U);
  EXPECT_EQ(stages[0].answers_size(), 1) << "of this load";
  EXPECT_EQ(stages[0].answers(0).energy_lower(), -2.04);
  EXPECT_FALSE(stages[1].answers(0).has_energy_lower());
}

TEST(ToResult, KeepsALoadThatFailedWithoutArrays) {
  Fetched failed = fetched();
  failed.job.mutable_spec()->add_load_cases()->set_name("two");
  v1::LoadCaseAnswer& answer = *failed.job.mutable_status()->add_answers();
  answer.set_status(v1::LoadCaseAnswer::STATUS_FAILED);
  answer.mutable_error()->set_message("not finite");
  const results::Result result = to_result(failed);
  EXPECT_EQ(result.loads[1].answer.error().message(), "not finite");
  EXPECT_TRUE(std::isnan(result.loads[1].answer.energy()));
  EXPECT_FALSE(result.arrays.contains("loads/two/traces/0/u_plus"));
}

/// Three rows over two loads, of which the middle one did not converge; traces of the last two.
Fetched fetched_sweep() {
  Fetched result = fetched();
  v1::Job& job = result.job;
  job.mutable_status()->clear_answers();
  job.mutable_spec()->clear_solver();
  job.mutable_spec()->add_load_cases()->set_name("two");
  job.mutable_spec()->mutable_sweep()->mutable_coefficients()->set_upload("uploads/1");
  job.mutable_spec()->mutable_sweep()->add_traces(1);
  job.mutable_spec()->mutable_sweep()->add_traces(2);
  job.mutable_status()->mutable_sweep_answer()->set_rows(3);
  job.mutable_status()->mutable_sweep_answer()->mutable_solve_time()->set_seconds(2);
  job.mutable_status()->mutable_error()->set_message("row 1 is odd");
  BlockMaker maker;
  maker.add("interfaces/0/s", Reals{0, 1}).add("interfaces/0/x", Reals{0, 1});
  maker.add("interfaces/0/y", Reals{0, 0}).add("interfaces/0/kind", Integers{2, 2});
  maker.add("sweep/status", Integers{3, 4, 3}).add("sweep/steps", Integers{1, 7, 2});
  maker.add("sweep/energy", Reals{-1, 0, -3}).add("sweep/contact_length", Reals{0, 0, 1});
  maker.add("sweep/kkt", Reals{1e-15, 1, 1e-14});
  maker.add("sweep/displacement", Reals{0.5, 0, 0.25}, 1);
  maker.add("sweep/contact", std::vector<std::uint8_t>{0, 0, 0, 1, 1, 1}, 2);
  maker.add("sweep/contact_nodes", Integers{0, 0, 0, 1}, 2);
  for (const char* name : {"u_minus", "u_plus", "jump", "pressure", "flux", "force"}) {
    maker.add(std::string("traces/2/0/") + name, Reals{0.5, 0.75});
  }
  maker.add("traces/2/0/contact", Integers{1, 1});
  result.result_block = block_of(maker);
  return result;
}

TEST(ToResult, KeepsTheColumnsOfASweep) {
  const results::Result result = to_result(fetched_sweep());
  ASSERT_TRUE(result.sweep);
  const results::Sweep& sweep = *result.sweep;
  EXPECT_EQ(sweep.loads, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(sweep.inclusions, std::vector<std::string>{"fibre"});
  EXPECT_THAT(sweep.status(), ElementsAre(3, 4, 3));
  EXPECT_THAT(sweep.integers("steps"), ElementsAre(1, 7, 2));
  EXPECT_THAT(sweep.numbers("energy"), ElementsAre(-1, 0, -3));
  EXPECT_THAT(sweep.numbers("contact_length"), ElementsAre(0, 0, 1));
  EXPECT_THAT(sweep.numbers("displacement"), ElementsAre(0.5, 0, 0.25));
  EXPECT_TRUE(sweep.numbers("slope").empty()) << "nothing tilts";
  EXPECT_THAT(results::entries_at<std::uint8_t>(sweep.columns, "contact"),
              ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(sweep.integers("contact_nodes"), ElementsAre(0, 0, 0, 1));
  EXPECT_EQ(sweep.error, "row 1 is odd");
  EXPECT_EQ(results::solve_seconds(result), 2);
  EXPECT_TRUE(sweep.numbers("coefficients").empty()) << "the server does not give them back";
}

TEST(ToResult, MakesLoadsOfTheRowsThatHaveTraces) {
  const results::Result result = to_result(fetched_sweep());
  EXPECT_THAT(result.sweep->integers("kept"), ElementsAre(2)) << "row 1 came to no end";
  ASSERT_EQ(result.loads.size(), 1U);
  const results::Load& load = result.loads[0];
  EXPECT_EQ(load.name(), "row-2");
  EXPECT_EQ(load.answer.status(), v1::LoadCaseAnswer::STATUS_CONVERGED);
  EXPECT_EQ(load.answer.iterations(), 2);
  EXPECT_EQ(load.answer.energy(), -3);
  EXPECT_EQ(load.answer.inclusions(0).displacement(), 0.25);
  EXPECT_THAT(results::entries_at<double>(result.arrays, "loads/row-2/traces/0/u_plus"),
              ElementsAre(0.5, 0.75));
  ASSERT_EQ(load.answer.contact_intervals_size(), 1);
  EXPECT_EQ(load.answer.contact_intervals(0).begin(), 0);
  EXPECT_EQ(load.answer.contact_intervals(0).end(), 1);
}

/// With the slopes of the inclusion in an array of this shape.
Fetched fetched_tilting(std::initializer_list<std::uint64_t> shape) {
  Fetched result = fetched_sweep();
  BlockMaker maker;
  maker.add("sweep/slope", Reals{1, 2, 3, 4, 5, 6});
  client::Block& block = result.result_block;
  v1::ArrayLayout& slope = *block.layout.add_arrays();
  slope = maker.layout.arrays(0);
  slope.clear_shape();
  for (const std::uint64_t extent : shape) slope.add_shape(extent);
  slope.set_offset(block.bytes.size());
  block.bytes.insert(block.bytes.end(), maker.bytes.begin(), maker.bytes.end());
  return result;
}

TEST(ToResult, KeepsTheSlopesOfASweep) {
  const results::Result result = to_result(fetched_tilting({3, 1, 2}));
  EXPECT_THAT(result.sweep->numbers("slope"), ElementsAre(1, 2, 3, 4, 5, 6));
  const v1::InclusionAnswer& fibre = result.loads.at(0).answer.inclusions(0);
  EXPECT_EQ(fibre.slope_x(), 5);
  EXPECT_EQ(fibre.slope_y(), 6);
  EXPECT_TRUE(std::isnan(fibre.moment_x()));
  for (const auto& shape : {std::initializer_list<std::uint64_t>{3, 2, 1}, {3, 2}, {1, 3, 2}})
    EXPECT_THROW(to_result(fetched_tilting(shape)), results::Error);
}

TEST(ToResult, TakesASweepWithoutInclusionsAndCracks) {
  Fetched plain = fetched_sweep();
  plain.mesh.clear_inclusions();
  plain.mesh_block = mesh_block(1, -1);
  for (v1::ArrayLayout& array : *plain.result_block.layout.mutable_arrays()) {
    if (array.name() == "sweep/displacement" || array.name() == "sweep/contact") {
      array.set_shape(1, 0);
    }
    if (array.name() == "sweep/contact_nodes") {
      array.set_shape(0, 0);
    }
  }
  const results::Result result = to_result(plain);
  EXPECT_TRUE(result.sweep->numbers("displacement").empty());
  EXPECT_TRUE(results::entries_at<std::uint8_t>(result.sweep->columns, "contact").empty());
}

TEST(ToResult, RefusesASweepThatDoesNotFitTogether) {
  const auto refused = [](const auto& spoil) {
    Fetched odd = fetched_sweep();
    for (v1::ArrayLayout& array : *odd.result_block.layout.mutable_arrays()) {
      spoil(array);
    }
    EXPECT_THROW(to_result(odd), results::Error);
  };
  for (const char* name : {"status", "steps", "energy", "contact_length", "kkt", "displacement",
                           "contact", "contact_nodes"}) {
    const std::string full = std::string("sweep/") + name;
    refused([&](v1::ArrayLayout& array) {
      if (array.name() == full) {
        array.set_name("other");
      }
    });
    refused([&](v1::ArrayLayout& array) {
      if (array.name() == full) {
        array.set_type(array.type() == v1::ArrayLayout::TYPE_UINT8 ? v1::ArrayLayout::TYPE_INT32
                                                                   : v1::ArrayLayout::TYPE_UINT8);
      }
    });
    refused([&](v1::ArrayLayout& array) {
      if (array.name() == full) {
        array.set_shape(0, 1);
      }
    });
  }
}

}  // namespace
}  // namespace anticrack::cli
