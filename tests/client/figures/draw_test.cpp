// SPDX-License-Identifier: GPL-3.0-or-later
//
// Pictures by the real gnuplot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "figures/figures.hpp"
#include "results/error.hpp"
#include "support/sample_result.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::figures {
namespace {

namespace fs = std::filesystem;
using anticrack::testing::sample_result;
using anticrack::testing::TemporaryFolder;
using anticrack::testing::with_stages;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

TEST(Draw, makes_every_figure_of_every_load) {
  const TemporaryFolder folder;
  const Drawn drawn = draw(with_stages(sample_result(10)), folder / "new/figures");
  EXPECT_THAT(drawn.notes, IsEmpty());
  EXPECT_EQ(drawn.files.size(), 24u);
  std::set<std::string> expected;
  for (const char* load : {"opening", "partly_closed"}) {
    for (const char* figure : {"", "-membrane", "-plan", "-traces", "-convergence", "-accuracy"}) {
      expected.insert(std::string(load) + figure + ".png");
      expected.insert(std::string(load) + figure + ".svg");
    }
  }
  EXPECT_EQ(files_in(folder / "new/figures"), expected);
  for (const fs::path& file : drawn.files) {
    const std::string bytes = bytes_of(file);
    EXPECT_GT(bytes.size(), 8000u) << file;
    if (file.extension() == ".png") {
      EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1A\n") << file;
    } else {
      EXPECT_THAT(bytes.substr(0, 200), HasSubstr("<svg")) << file;
      EXPECT_THAT(bytes, HasSubstr("A made-up membrane"));
      EXPECT_THAT(bytes.substr(bytes.size() - 10), HasSubstr("</svg>")) << file;
    }
  }
}

std::pair<unsigned, unsigned> size_of(const fs::path& png) {
  const std::string bytes = bytes_of(png);
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value << 8 | static_cast<unsigned char>(bytes.at(i));
    }
    return value;
  };
  return {number(16), number(20)};
}

TEST(Draw, has_the_size_of_a_column_in_every_format) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  const Options options{
      .formats = {Format::pdf, Format::svg, Format::png}, .dpi = 127, .titles = false};
  EXPECT_EQ(draw(result, folder.path(), options).files.size(), 15u);
  EXPECT_EQ(size_of(folder / "opening-traces.png"), (std::pair{425u, 340u}));  // 85 mm x 68 mm
  EXPECT_EQ(size_of(folder / "opening.png"), (std::pair{850u, 740u}));         // the plan below
  const std::string pdf = bytes_of(folder / "opening-membrane.pdf");
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  const std::string svg = bytes_of(folder / "opening-traces.svg");
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 321 257\""));  // at 96 dpi
  EXPECT_THAT(svg, Not(HasSubstr("A made-up membrane")));
  draw(result, folder.path(), {.formats = {Format::png}, .dpi = 127});
  EXPECT_GT(size_of(folder / "opening-traces.png").second, 350u);  // the title comes on top
}

TEST(Draw, says_what_it_left_out) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads[0].fields.clear();
  result.loads[1].status = results::Status::failed;
  result.loads[1].traces.clear();
  result.loads[1].fields.clear();
  result.loads.push_back(result.loads[0]);
  result.loads[2].name = "single step";
  for (auto* values :
       {&result.loads[2].history.criterion, &result.loads[2].history.energy,
        &result.loads[2].history.kkt.equilibrium, &result.loads[2].history.kkt.gap,
        &result.loads[2].history.kkt.sign, &result.loads[2].history.kkt.complementarity}) {
    values->resize(1);
  }
  result.loads[2].history.iteration.resize(1);
  result.loads[2].history.contact_count.resize(1);
  const Drawn drawn = draw(result, folder.path(), {.formats = {Format::png}});
  EXPECT_EQ(files_in(folder.path()),
            (std::set<std::string>{"opening-convergence.png", "opening-traces.png",
                                   "single_step-traces.png"}));
  EXPECT_THAT(drawn.notes,
              ElementsAre(HasSubstr("no fields; to have them: anticrack job fetch jobs/"),
                          HasSubstr("no traces (failed)"), HasSubstr("no fields"),
                          HasSubstr("1 load was solved in one or two steps")));
}

TEST(Draw, leaves_out_what_says_nothing_and_draws_what_is_asked_for) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  result.interfaces.push_back(result.interfaces[0]);
  result.interfaces[1].name = "glued";
  std::ranges::fill(result.interfaces[1].edges.kind, results::Kind::inclusion);
  std::ranges::fill(result.interfaces[1].edges.inclusion, 0);
  result.loads[0].traces.push_back(result.loads[0].traces[0]);
  auto& history = result.loads[0].history;
  for (auto* values : {&history.criterion, &history.energy, &history.kkt.equilibrium,
                       &history.kkt.gap, &history.kkt.sign, &history.kkt.complementarity})
    values->resize(2);
  history.iteration.resize(2);
  history.contact_count.resize(2);
  const Drawn drawn = draw(result, folder / "all", {.formats = {Format::png}});
  EXPECT_EQ(files_in(folder / "all"),
            (std::set<std::string>{"opening.png", "opening-membrane.png", "opening-plan.png",
                                   "opening-traces.png"}));
  EXPECT_THAT(drawn.notes, ElementsAre(HasSubstr("no traces drawn; --interface glued"),
                                       HasSubstr("one or two steps: no convergence")));
  const Options asked{
      .formats = {Format::png}, .only = {"traces", "convergence"}, .interface = "glued"};
  EXPECT_THAT(draw(result, folder / "some", asked).notes, IsEmpty());
  EXPECT_EQ(files_in(folder / "some"),
            (std::set<std::string>{"opening-convergence.png", "opening-traces-2.png"}));
}

TEST(Draw, draws_no_accuracy_of_a_single_stage) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  result.loads[0].stages = {{128}, {-1}, {-1.1}, {-1}, {0.1}, {0.1}, {0.1}};
  const Drawn drawn = draw(result, folder.path(), {.formats = {Format::png}});
  EXPECT_EQ(files_in(folder.path()).count("opening-accuracy.png"), 0u);
  EXPECT_THAT(drawn.notes, ElementsAre(HasSubstr("fewer than two stages have bounds")));
}

TEST(Draw, replaces_old_figures) {
  const TemporaryFolder folder;
  std::ofstream(folder / "opening-traces.svg") << "old";
  auto result = sample_result(4);
  result.loads.resize(1);
  draw(result, folder.path(), {.formats = {Format::svg}});
  EXPECT_GT(fs::file_size(folder / "opening-traces.svg"), 1000u);
}

TEST(Draw, runs_nothing_that_a_case_says) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  result.title = "<script>&amp;</script> `touch pwned` '; system('touch pwned'); '\n!touch pwned";
  result.loads[0].inclusions = {{"'`touch pwned`", 1, 0, 0}, {"\n!touch pwned\n", 2, 0, 0}};
  result.mesh.inclusions = {"'`touch pwned`", "\n!touch pwned\n"};
  const Drawn drawn = draw(result, folder.path());
  EXPECT_EQ(drawn.files.size(), 10u);
  EXPECT_EQ(files_in(folder.path()).count("pwned"), 0u);
  EXPECT_THAT(bytes_of(folder / "opening-traces.svg"), Not(HasSubstr("<script>&amp;</script>")));
}

TEST(Draw, survives_degenerate_answers) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  auto& still = result.loads[0];
  for (auto& field : still.fields) std::fill(field.u.begin(), field.u.end(), 0.0);
  for (auto* values : {&still.traces[0].u_minus, &still.traces[0].u_plus, &still.traces[0].jump}) {
    std::fill(values->begin(), values->end(), 0.0);
  }
  still.history.iteration = {1};
  for (auto* values :
       {&still.history.criterion, &still.history.energy, &still.history.kkt.equilibrium,
        &still.history.kkt.gap, &still.history.kkt.sign, &still.history.kkt.complementarity}) {
    *values = {0.0};
  }
  still.history.contact_count = {0};

  auto& wild = result.loads[1];
  for (auto& field : wild.fields) std::fill(field.u.begin(), field.u.end(), results::unknown);
  for (auto* values : {&wild.traces[0].u_minus, &wild.traces[0].u_plus, &wild.traces[0].jump}) {
    std::fill(values->begin(), values->end(), results::unknown);
  }
  for (double& criterion : wild.history.criterion) criterion = results::unknown;
  EXPECT_NO_THROW(draw(result, folder.path(), {.formats = {Format::png}}));
}

TEST(Draw, draws_an_interface_that_is_bent_and_one_that_stands_upright) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  auto upright = result.interfaces[0];
  std::swap(upright.x, upright.y);
  result.interfaces.push_back(upright);
  result.interfaces[0].y[2] = 0.1;
  result.loads[0].traces.push_back(result.loads[0].traces[0]);
  draw(result, folder.path(), {.formats = {Format::png}});
  EXPECT_TRUE(fs::exists(folder / "opening-traces.png"));
  EXPECT_TRUE(fs::exists(folder / "opening-traces-2.png"));
}

TEST(Draw, draws_an_interface_that_is_closed_and_names_several) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  auto ring = result.interfaces[0];
  ring.name = "ring";
  for (std::size_t i = 0; i < ring.node_count(); ++i) {
    const double angle = 2 * std::acos(-1.0) * static_cast<double>(i) / 8;
    ring.x[i] = std::cos(angle);
    ring.y[i] = std::sin(angle);
  }
  result.interfaces.push_back(ring);
  result.loads[0].traces.push_back(result.loads[0].traces[0]);
  draw(result, folder.path(), {.formats = {Format::svg}});
  EXPECT_THAT(bytes_of(folder / "opening-traces.svg"), HasSubstr("displacements on sigma"));
  EXPECT_THAT(bytes_of(folder / "opening-traces-2.svg"), HasSubstr("displacements on ring"));
}

TEST(Draw, draws_the_steps_of_the_active_set) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  result.loads.resize(1);
  auto& load = result.loads[0];
  load.method = "active-set";
  load.epsilon = load.theta = load.theta_star = results::unknown;
  load.iterations = 3;
  load.history = {{1, 2, 3},
                  {1, 0.5, 0},
                  {-1, -2, -2},
                  {5, 4, 4},
                  {{0, 0, 0}, {0.1, 0.01, 1e-17}, {0, 0, 0}, {0.2, 0, 0}}};
  draw(result, folder.path(), {.formats = {Format::svg}});
  const std::string svg = bytes_of(folder / "opening-convergence.svg");
  EXPECT_THAT(svg, HasSubstr("converged after 3 steps"));
  EXPECT_THAT(svg, HasSubstr("complementarity"));
  EXPECT_THAT(svg, HasSubstr("KKT residual"));
}

/// The sheet of `sample_result` stretched and moved.
results::Result placed(double width, double height, double x, double y) {
  auto result = sample_result(4);
  result.loads.resize(1);
  const auto move = [](std::vector<double>& values, std::size_t first, std::size_t step,
                       double factor, double by) {
    for (std::size_t i = first; i < values.size(); i += step) values[i] = factor * values[i] + by;
  };
  move(result.mesh.xy, 0, 2, width / 2, x);
  move(result.mesh.xy, 1, 2, height / 2, y);
  for (auto& interface : result.interfaces) {
    move(interface.x, 0, 1, width / 2, x);
    move(interface.y, 0, 1, height / 2, y);
    move(interface.s, 0, 1, width / 2, 0);
  }
  return result;
}

TEST(Draw, draws_sheets_of_any_shape_size_and_place) {
  const TemporaryFolder folder;
  struct Sheet {
    double width, height, x, y;
  };
  const Options options{.formats = {Format::svg}};
  for (const auto& [width, height, x, y] :
       {Sheet{60, 10, 30, 5}, Sheet{80, 10, 40, 6}, Sheet{100, 10, 50, 0}, Sheet{100, 10, 50, 30},
        Sheet{1e4, 1, 0, 0}, Sheet{1, 50, 0.5, 25}, Sheet{1, 1e4, 0, 0}, Sheet{1e-9, 1e-9, 0, 0},
        Sheet{1e9, 1e9, 0, 0}, Sheet{1e9, 1e-3, 5e8, 1e5}, Sheet{100, 100, 6000050, 50},
        Sheet{1, 1, 5e5, -6e6}, Sheet{1e-3, 1e-3, -1e6, 0}}) {
    const auto result = placed(width, height, x, y);
    EXPECT_EQ(draw(result, folder.path(), options).files.size(), 5u) << width << " x " << height;
    EXPECT_NO_THROW(draw_together(result, folder.path(), options)) << width << " x " << height;
  }
}

TEST(Draw, says_what_the_labels_of_far_places_leave_out) {
  const TemporaryFolder folder;
  draw(placed(100, 100, 6000050, 50), folder.path(), {.formats = {Format::svg}});
  for (const char* figure : {"opening", "opening-membrane", "opening-plan", "opening-traces"}) {
    const std::string svg = bytes_of(folder / (std::string(figure) + ".svg"));
    EXPECT_THAT(svg, HasSubstr("x \xE2\x88\x92 6000000")) << figure;
    EXPECT_THAT(svg, Not(HasSubstr("6.0000"))) << figure;
  }
}

TEST(Draw, draws_of_many_interfaces_and_loads_what_is_asked_for) {
  const TemporaryFolder folder;
  auto result = sample_result(2);
  result.loads.resize(1);
  auto& load = result.loads[0];
  load.history = {};
  for (std::size_t i = 1; i < 13; ++i) {
    result.interfaces.push_back(result.interfaces[0]);
    result.interfaces[i].name = "line-" + std::to_string(i);
    load.traces.push_back(load.traces[0]);
  }
  for (double& jump : load.traces[4].jump) jump *= 2;
  const auto drawn = [&](const char* name, Options options) {
    options.formats = {Format::svg};
    return draw(result, folder / name, options);
  };
  const Drawn few = drawn("few", {});
  EXPECT_EQ(files_in(folder / "few"),
            (std::set<std::string>{"opening.svg", "opening-membrane.svg", "opening-plan.svg",
                                   "opening-traces-5.svg"}));
  EXPECT_THAT(few.notes, Contains(HasSubstr("of 13 interfaces that can open the most eventful")));
  EXPECT_EQ(drawn("all", {.all_interfaces = true}).files.size(), 16u);
  EXPECT_EQ(drawn("only", {.only = {"traces"}}).files.size(), 13u);
  EXPECT_EQ(drawn("one", {.only = {"traces"}, .interface = "line-3"}).files.size(), 1u);

  result.loads.resize(13, load);
  for (std::size_t l = 0; l < result.loads.size(); ++l)
    result.loads[l].name = "load-" + std::to_string(l);
  const Drawn first = drawn("first", {.only = {"plan"}});
  EXPECT_EQ(first.files.size(), 12u);
  EXPECT_THAT(first.notes, ElementsAre(HasSubstr("the first 12 of 13 loads drawn; --load NAME")));
  const Drawn every = drawn("every", {.only = {"plan"}, .all_loads = true});
  EXPECT_EQ(every.files.size(), 13u);
  EXPECT_THAT(every.notes, IsEmpty());
}

TEST(Draw, lays_the_first_eight_loads_over_each_other) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  for (std::size_t i = 2; i < 10; ++i) {
    result.loads.push_back(result.loads[i % 2]);
    result.loads[i].name = "load-" + std::to_string(i);
  }
  result.loads[0].traces.clear();
  const Drawn drawn =
      draw_together(result, folder.path(), {.formats = {Format::svg}, .interface = "sigma"});
  EXPECT_EQ(files_in(folder.path()), std::set<std::string>{"together.svg"});
  EXPECT_THAT(drawn.notes, ElementsAre(HasSubstr("the first 8 of 9 loads")));
  const std::string svg = bytes_of(folder / "together.svg");
  for (const char* shown : {"partly closed", "load-8", "pressure", "[u]", "interface"})
    EXPECT_THAT(svg, HasSubstr(shown));
  for (const char* left_out : {"opening", "load-9"}) EXPECT_THAT(svg, Not(HasSubstr(left_out)));
}

TEST(Draw, lays_nothing_over_each_other_that_is_not_there) {
  const TemporaryFolder folder;
  auto result = sample_result(4);
  try {
    draw_together(result, folder.path(), {.interface = "sigmo"});
    FAIL() << "drew it";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no interface sigmo; did you mean sigma?");
  }
  for (auto& load : result.loads) load.traces.clear();
  EXPECT_THROW(draw_together(result, folder.path()), Error);
  EXPECT_THAT(files_in(folder.path()), IsEmpty());
}

TEST(Draw, refuses_a_folder_it_cannot_write_and_a_broken_result) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  EXPECT_THROW(draw(sample_result(2), folder / "file"), results::Error);
  EXPECT_THROW(draw(sample_result(2), folder / "file/figures"), results::Error);
  EXPECT_THROW(draw(sample_result(2), "/proc/figures"), results::Error);
  auto result = sample_result(2);
  result.mesh.triangles[0] = 99;
  EXPECT_THROW(draw(result, folder / "figures"), Error);
  EXPECT_FALSE(fs::exists(folder / "figures"));
}

}  // namespace
}  // namespace anticrack::figures
