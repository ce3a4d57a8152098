// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/panels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "figures/text.hpp"
#include "support/sample_result.hpp"

namespace anticrack::figures {
namespace {

using anticrack::testing::sample_pair;
using anticrack::testing::sample_result;
using anticrack::testing::with_stages;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<Output> both{{Format::png, "a.png"}, {Format::svg, "a.svg"}};

std::string overview(const results::Result& result, const results::Load& load,
                     const Surface& membrane) {
  return script(overview_picture(result, load, membrane, most_eventful(result, {load})), both);
}

/// All scripts of a load, one after the other.
std::string scripts(const results::Result& result, const results::Load& load) {
  const Surface membrane = surface(result, load, 10000);
  return overview(result, load, membrane) + script(membrane_picture(result, load, membrane), both) +
         script(plan_picture(result, load, membrane), both) +
         script(together_picture(result, 0), both) + script(traces_picture(result, load, 0), both) +
         script(convergence_picture(result, load), both) +
         (bounded_stages(load) == 0 ? "" : script(accuracy_picture(result, load), both));
}

/// What gnuplot would take for commands: the script without the insides of quoted strings. Throws
/// if a quoted string runs over the end of a line.
std::string commands(const std::string& script) {
  std::string outside;
  bool inside = false;
  for (const char c : script) {
    if (c == '\'') {
      inside = !inside;  // a doubled quote closes and opens again
    } else if (inside && c == '\n') {
      throw std::runtime_error("a string runs over the end of its line");
    } else if (!inside) {
      outside += c;
    }
  }
  return outside;
}

TEST(Script, draws_both_formats_from_one_copy_of_the_data) {
  const auto result = sample_result(4);
  const std::string drawn =
      overview(result, result.loads[0], surface(result, result.loads[0], 1000));
  EXPECT_THAT(drawn, HasSubstr("set output 'a.png'"));
  EXPECT_THAT(drawn, HasSubstr("set output 'a.svg'"));
  EXPECT_EQ(drawn.find("$membrane << EOD"), drawn.rfind("$membrane << EOD"));
  EXPECT_THAT(drawn, HasSubstr("amplified"));
  EXPECT_THAT(drawn, HasSubstr("u"));
}

TEST(Script, marks_contact_only_where_there_is_some) {
  const auto result = sample_result(10);
  EXPECT_THAT(script(traces_picture(result, result.loads[0], 0), both),
              Not(HasSubstr("title 'contact'")));
  EXPECT_THAT(script(traces_picture(result, result.loads[1], 0), both),
              HasSubstr("title 'contact'"));
}

TEST(Script, draws_the_pressure_only_where_there_is_contact) {
  const auto result = sample_result(10);
  for (const bool contact : {false, true}) {
    const results::Load& load = result.loads[contact ? 1 : 0];
    for (const std::string& drawn : {script(traces_picture(result, load, 0), both),
                                     overview(result, load, surface(result, load, 1000))}) {
      EXPECT_EQ(drawn.find("$pressure << EOD") != std::string::npos, contact);
      EXPECT_EQ(drawn.find("'pressure'") != std::string::npos, contact);
    }
  }
}

TEST(Script, says_that_spikes_of_the_pressure_are_cut_off) {
  auto result = sample_result(10);
  auto& trace = result.loads[1].traces[0];
  const auto drawn = [&] { return script(traces_picture(result, result.loads[1], 0), both); };
  for (double& pressure : trace.pressure) pressure = pressure == 0 ? 0 : 0.5;
  EXPECT_THAT(drawn(), Not(HasSubstr("cut off")));
  *std::ranges::find(trace.contact, 1) = 0;
  const auto closed = std::ranges::find(trace.contact, 1) - trace.contact.begin();
  result.interfaces[0].s[static_cast<std::size_t>(closed) - 1] =
      result.interfaces[0].s[static_cast<std::size_t>(closed) + 1] - 1e-6;  // a graded mesh
  result.interfaces[0].s[static_cast<std::size_t>(closed)] =
      result.interfaces[0].s[static_cast<std::size_t>(closed) + 1] - 5e-7;
  trace.pressure[static_cast<std::size_t>(closed)] = 3.2e4;
  EXPECT_THAT(drawn(), HasSubstr("'cut off at the tips, up to 1.6\xC3\x97"));
  EXPECT_THAT(drawn(), HasSubstr("set yrange [0:0.3975]"));
}

/// The first one again, with the load's traces on it.
void add_second_interface(results::Result& result, results::Load& load) {
  result.interfaces.push_back(result.interfaces[0]);
  result.interfaces[1].name = "second";
  load.traces.push_back(load.traces[0]);
}

TEST(Script, shows_the_most_eventful_interface_in_the_overview) {
  auto result = sample_result(4);
  auto& load = result.loads[0];
  add_second_interface(result, load);
  const auto seen = [&] { return overview(result, load, surface(result, load, 1000)); };
  EXPECT_THAT(seen(), HasSubstr("displacements on sigma"));
  for (double& jump : load.traces[1].jump) jump *= -2;
  EXPECT_THAT(seen(), HasSubstr("displacements on second"));
  // Nothing is open: the contact counts.
  for (auto& trace : load.traces) std::ranges::fill(trace.jump, 0.0);
  load.traces[1].contact[4] = 1;
  EXPECT_THAT(seen(), HasSubstr("displacements on second"));
}

TEST(Script, shows_the_pressure_of_the_interface_that_has_most_of_it) {
  auto result = sample_result(10);
  auto& load = result.loads[1];
  add_second_interface(result, load);
  const auto seen = [&] { return overview(result, load, surface(result, load, 1000)); };
  EXPECT_THAT(seen(), HasSubstr("'contact pressure on sigma'"));
  // The first opens more and is in contact in a single node.
  auto& open = load.traces[0];
  for (double& jump : open.jump) jump *= 2;
  const auto closed = std::ranges::find(open.contact, 1);
  std::fill(closed + 1, open.contact.end(), 0);
  EXPECT_THAT(seen(), HasSubstr("displacements on sigma"));
  EXPECT_THAT(seen(), HasSubstr("'contact pressure on second'"));
}

TEST(Script, has_one_number_at_the_near_corner_of_the_membrane) {
  auto result = sample_result(4);
  const auto drawn = [&] {
    const Surface membrane = surface(result, result.loads[0], 1000);
    return script(membrane_picture(result, result.loads[0], membrane), both);
  };
  EXPECT_THAT(drawn(), HasSubstr("set ytics -0.5, 0.5, 1 nomirror"));
  for (double& x : result.interfaces[0].x) x = -x;  // seen from the other side
  EXPECT_THAT(drawn(), HasSubstr("set ytics -1, 0.5, 0.8 nomirror"));
}

TEST(Script, keeps_a_far_side_that_rises_out_of_the_heading) {
  auto result = sample_result(4);
  const results::Load& load = result.loads[0];
  const auto drawn = [&] {
    return script(membrane_picture(result, load, surface(result, load, 1000)), both);
  };
  EXPECT_THAT(drawn(), HasSubstr("set view 52, 28, 1.5\n"));
  for (auto& field : result.loads[0].fields)
    for (std::size_t i = 0; i < field.u.size(); ++i)
      field.u[i] = result.mesh.xy[2 * static_cast<std::size_t>(field.nodes[i]) + 1];
  EXPECT_THAT(drawn(), HasSubstr("set view 52, 28, 1.3"));
}

TEST(Script, has_a_light_ground_below_names_on_the_membrane) {
  const auto result = sample_result(4);
  const std::string drawn = script(
      membrane_picture(result, result.loads[0], surface(result, result.loads[0], 1000)), both);
  EXPECT_THAT(drawn, HasSubstr("set style textbox opaque"));
  EXPECT_THAT(drawn, ::testing::ContainsRegex("set label 10 'fibre' at [^\n]* boxed\n"));
}

TEST(Script, labels_contours_and_marks_the_side_that_came_off) {
  auto result = sample_result(20);
  const auto draw = [&] {
    return script(plan_picture(result, result.loads[0], surface(result, result.loads[0], 10000)),
                  both);
  };
  const std::string drawn = draw();
  EXPECT_THAT(drawn, HasSubstr("title 'the side that came off'"));
  EXPECT_THAT(drawn, HasSubstr("set label '\xE2\x88\x92"));  // a level below zero
  EXPECT_THAT(drawn, HasSubstr("'fibre'"));
  EXPECT_THAT(drawn, HasSubstr("'|\xE2\x88\x87u|"));  // T is a law
  result.mesh.tension_law.clear();
  EXPECT_THAT(draw(), HasSubstr("'|T \xE2\x88\x87u|"));
}

TEST(Script, names_an_inclusion_where_it_lies) {
  auto result = sample_result(4);
  auto& load = result.loads[0];
  const auto named = [&] { return script(traces_picture(result, load, 0), both); };
  EXPECT_THAT(named(), HasSubstr("'fibre' at graph 0.5"));
  EXPECT_THAT(named(), HasSubstr("A = 0.0863'"));
  result.units.length = "mm";
  EXPECT_THAT(named(), HasSubstr("A = 0.0863 mm'"));
  result.units.length.clear();
  // Not one that lies on no edge here, whatever its A.
  load.inclusions = {{"other", 0.0863, 0, 0}, {"fibre", 0.0863, 0, 0}};
  EXPECT_THAT(named(), HasSubstr("'fibre' at graph 0.5"));
  EXPECT_THAT(named(), HasSubstr("A = 0.0863 (fibre)'"));
  EXPECT_THAT(named(), Not(HasSubstr("other")));
}

TEST(Script, tells_the_slope_of_an_inclusion_that_tilts) {
  auto result = sample_result(4);
  result.loads[0].inclusions[0].slope_y = 0.25;
  EXPECT_THAT(script(traces_picture(result, result.loads[0], 0), both),
              HasSubstr("A = 0.0863, B = (0, 0.25)'"));
}

TEST(Script, names_two_inclusions_of_one_displacement) {
  const auto result = sample_pair(4);
  const std::string drawn = script(traces_picture(result, result.loads[0], 0), both);
  EXPECT_THAT(drawn, HasSubstr("'left' at graph 0.375"));
  EXPECT_THAT(drawn, HasSubstr("'right' at graph 0.625"));
  EXPECT_THAT(drawn, HasSubstr("A = 0.0863 (right),  A = 0.0863 (left)'"));
}

TEST(Script, says_in_every_panel_that_a_load_did_not_converge) {
  auto result = sample_result(4);
  auto& load = result.loads[0];
  EXPECT_THAT(scripts(result, load), Not(HasSubstr("not converged")));
  load.status = results::Status::not_converged;
  EXPECT_THAT(script(traces_picture(result, load, 0), both), HasSubstr("not converged"));
  EXPECT_THAT(script(membrane_picture(result, load, surface(result, load, 1000)), both),
              HasSubstr("not converged"));
}

TEST(Script, shows_rounding_as_zero) {
  auto result = sample_result(4);
  auto& trace = result.loads[0].traces[0];
  for (auto* values : {&trace.u_minus, &trace.u_plus, &trace.jump}) {
    for (double& value : *values) value *= 1e-14;
  }
  result.loads[0].energy = -6;  // u is about 1
  EXPECT_THAT(script(traces_picture(result, result.loads[0], 0), both),
              HasSubstr("'displacement'"));
  result.loads[0].energy = -6e-30;  // all of u is that small
  EXPECT_THAT(script(traces_picture(result, result.loads[0], 0), both),
              HasSubstr("'displacement [10\xE2\x81\xBB\xC2\xB9\xE2\x81\xB5]'"));
}

TEST(Script, breaks_a_title_and_keeps_the_name_of_the_load) {
  auto result = sample_result(4);
  const std::vector<Output> png{{Format::png, "a.png"}};
  const auto titled = [&] { return script(traces_picture(result, result.loads[0], 0), png); };
  EXPECT_THAT(titled(), HasSubstr("'A made-up membrane \xE2\x80\x94 opening'"));
  result.title = "A membrane with a title that fills its line";
  EXPECT_THAT(titled(), HasSubstr("label 101 'A membrane with a title that fills its line'"));
  EXPECT_THAT(titled(), HasSubstr("label 102 'opening'"));
  result.title = "";
  EXPECT_THAT(titled(), HasSubstr("label 101 'opening'"));
}

TEST(Script, gives_zero_a_place_on_the_log_axis) {
  auto result = sample_result(4);
  auto& load = result.loads[0];
  EXPECT_THAT(script(convergence_picture(result, load), both), Not(HasSubstr("ytics add")));
  load.history.criterion[4] = 0;
  EXPECT_THAT(script(convergence_picture(result, load), both),
              HasSubstr("set ytics add ('0' 1e-13)"));
  EXPECT_THAT(script(convergence_picture(result, load), both), HasSubstr("\n5 1e-13\n"));
}

TEST(Script, draws_epsilon_where_it_is_known) {
  auto result = sample_result(4);
  EXPECT_THAT(script(convergence_picture(result, result.loads[0]), both),
              HasSubstr("1e-12 with lines"));
  result.loads[0].epsilon = results::unknown;
  EXPECT_THAT(script(convergence_picture(result, result.loads[0]), both),
              Not(HasSubstr("\xCE\xB5 =")));
}

TEST(Script, shows_how_the_bounds_close_in) {
  auto result = with_stages(sample_result(4));
  results::Stages& stages = result.loads[0].stages;
  stages = {{100, 1000, 20000}, {-1, -1.5, -2},   {-3, -2.1, -2.002},
            {-1, -1.5, -1.998}, {0.9, 0.3, 0.03}, {results::unknown, 0.25, 0.01},
            {0.1, 0.2, 1}};
  const auto drawn = [&] { return script(accuracy_picture(result, result.loads[0]), both); };
  EXPECT_THAT(drawn(), HasSubstr("'energy 0.2 %, A 1 % on 20000 triangles, 3 stages'"));
  EXPECT_THAT(drawn(), HasSubstr("\n100 2 NaN -3 -1 -1 0.4 \n"));
  EXPECT_THAT(drawn(), HasSubstr("\n20000 0.002 0.01 -2.002 -1.998 -2 0.002 \n"));
  EXPECT_THAT(drawn(), HasSubstr("title 'A, half the width of its bounds'"));
  for (double& error : stages.displacement_error) error = results::unknown;
  EXPECT_THAT(drawn(), Not(HasSubstr("title 'A, half")));
}

TEST(Script, leaves_out_stages_without_bounds) {
  auto result = with_stages(sample_result(4));
  results::Stages& stages = result.loads[0].stages;
  EXPECT_EQ(bounded_stages(result.loads[0]), 5U);
  stages.energy_lower[0] = results::unknown;
  stages.energy[1] = stages.energy_upper[1] = stages.energy_lower[1] = 0;
  EXPECT_EQ(bounded_stages(result.loads[0]), 3U);
  EXPECT_THAT(script(accuracy_picture(result, result.loads[0]), both), HasSubstr("3 stages"));
  EXPECT_EQ(bounded_stages(sample_result(4).loads[0]), 0U);
}

TEST(Script, shows_the_mesh_of_a_job_with_an_accuracy) {
  const auto drawn = [](const results::Result& result, std::size_t limit) {
    const results::Load& load = result.loads[0];
    return script(membrane_picture(result, load, surface(result, load, limit)), both);
  };
  EXPECT_THAT(drawn(with_stages(sample_result(4)), 1000), HasSubstr("border linewidth 0.2"));
  EXPECT_THAT(drawn(with_stages(sample_result(4)), 100), HasSubstr("noborder"));
  EXPECT_THAT(drawn(with_stages(sample_result(40)), 20000), HasSubstr("noborder"));
  EXPECT_THAT(drawn(sample_result(4), 1000), HasSubstr("noborder"));
}

TEST(Script, says_how_a_load_ended) {
  auto result = sample_result(4);
  result.loads[0].status = results::Status::not_converged;
  EXPECT_THAT(script(convergence_picture(result, result.loads[0]), both),
              HasSubstr("not converged after 180 iterations"));
}

TEST(Script, looks_over_the_minus_side) {
  auto result = sample_result(4);
  const double along_x = membrane_view(result);
  std::swap(result.interfaces[0].x, result.interfaces[0].y);
  EXPECT_NEAR(std::fmod(along_x - membrane_view(result) + 360, 360), 90, 1e-9);
}

/// All scripts of a result whose texts are all `text`.
std::string scripts_saying(const std::string& text) {
  auto result = with_stages(sample_result(4));
  auto& load = result.loads[0];
  result.title = load.name = load.method = load.mass = load.reason = text;
  load.inclusions = {{text, 0.1, 0, 0}, {text, 0.2, 0, 0}};
  result.mesh.inclusions = {text};
  result.interfaces[0].name = text;
  result.mesh.subdomains = {text, text};
  return scripts(result, load);
}

TEST(Script, lets_nothing_hostile_through) {
  const char* hostile[] = {
      "'; system('touch pwned'); '", "`touch pwned`",          "\n!touch pwned\n",
      "\"; system(\"touch pwned\")", "\\'; !touch pwned #",    "| touch pwned",
      "EOD\nsystem 'touch pwned'\n", "\xC0\xA7; !touch pwned", "@macro $data"};
  for (const std::string text : hostile) {
    // As long, with its blanks, so that it is broken and placed alike.
    std::string harmless = text;
    for (char& c : harmless) {
      if (c != ' ' && static_cast<unsigned char>(c) < 0x80) c = 'x';
    }
    const std::string drawn = scripts_saying(text);
    EXPECT_THAT(drawn, HasSubstr("graph 0.075"));  // the name of an inclusion
    EXPECT_EQ(commands(drawn), commands(scripts_saying(harmless))) << text;
    EXPECT_THAT(drawn, Not(HasSubstr("`")));
  }
}

TEST(Script, takes_only_bare_file_names) {
  const auto result = sample_result(4);
  for (const char* file : {"", "| sh", "../a.png", "a'b.png", "-a", "a b", "/a.png", "a\nb"}) {
    EXPECT_THROW(script(convergence_picture(result, result.loads[0]), {{Format::png, file}}),
                 std::invalid_argument)
        << file;
  }
}

TEST(Script, has_only_numbers_gnuplot_can_read) {
  auto result = sample_result(4);
  result.loads[0].traces[0].jump[3] = results::unknown;
  result.loads[0].history.criterion[3] = 0;
  result.loads[0].history.criterion[4] = -std::numeric_limits<double>::infinity();
  result.loads[0].theta_star = results::unknown;
  const std::string drawn = scripts(result, result.loads[0]);
  EXPECT_THAT(drawn, Not(HasSubstr("inf")));
  EXPECT_THAT(drawn, Not(HasSubstr("nan")));
  EXPECT_THAT(drawn, HasSubstr("\n5 NaN\n"));
}

}  // namespace
}  // namespace anticrack::figures
