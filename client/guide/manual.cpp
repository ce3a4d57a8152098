// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "guide/guide.hpp"

namespace anticrack::guide {
namespace {

/// The text escaped so that roff prints it unchanged, including "-".
std::string plain(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) result += "\\&";
    result += text[i] == '\\' ? "\\e" : text[i] == '-' ? "\\-" : std::string(1, text[i]);
  }
  return result;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

class PageWriter {
 public:
  PageWriter(const CLI::App& command, int section, const std::string& version)
      : _command(command), _section(section) {
    _out << ".TH " << upper(page_of(command)) << ' ' << section << " \"\" \"" << version << "\"\n";
    _out << ".SH NAME\n"
         << plain(page_of(command)) << " \\- " << plain(command.get_description()) << '\n';
    synopsis();
    listed("COMMANDS", [this] {
      for (const CLI::App* below : commands_of(_command))
        item("\\fB" + plain(below->get_name()) + "\\fR",
             fmt::format("{}: see {}({})", below->get_description(), page_of(*below), _section));
    });
    for (const bool arguments : {true, false}) {
      listed(arguments ? "ARGUMENTS" : "OPTIONS", [&] {
        for (const CLI::Option* option : options_of(_command))
          if (option->get_positional() == arguments) add(*option);
      });
    }
    footer();
    if (const CLI::App* const parent = command.get_parent()) {
      const std::string path = path_of(*parent);
      _out << ".SH SEE ALSO\n.BR " << plain(path.substr(0, path.find(' '))) << " (" << section
           << "):\noptions of every command, exit codes\n";
    }
  }

  Page page() const { return {fmt::format("{}.{}", page_of(_command), _section), _out.str()}; }

 private:
  static std::string page_of(const CLI::App& command) {
    std::string path = path_of(command);
    std::ranges::replace(path, ' ', '-');
    return path;
  }

  void synopsis() {
    _out << ".SH SYNOPSIS\n.B " << plain(path_of(_command)) << "\n[\\fIOPTIONS\\fR]";
    for (const CLI::Option* option : options_of(_command))
      if (option->get_positional()) _out << " \\fI" << plain(option->get_name(true)) << "\\fR";
    if (!commands_of(_command).empty()) _out << " \\fICOMMAND\\fR";
    _out << '\n';
  }

  /// Writes a section, unless `write` adds no item.
  template <class Write>
  void listed(const std::string& title, const Write& write) {
    _title = title;
    write();
  }

  void item(const std::string& head, const std::string& text) {
    if (!_title.empty()) _out << ".SH " << _title << '\n';
    _title.clear();
    _out << ".TP\n" << head << '\n' << plain(text) << '\n';
  }

  void add(const CLI::Option& option) {
    std::string head;
    for (const std::string& name : names_of(option))
      head += (head.empty() ? "" : ", ") +
              ((option.get_positional() ? "\\fI" : "\\fB") + plain(name) + "\\fR");
    const std::string type = option.get_positional() ? "" : type_of(option);
    item(type.empty() ? head : head + " \\fI" + plain(type) + "\\fR", option.get_description());
  }

  /// Writes paragraphs; one whose first line ends with a colon becomes a section of that name.
  void footer() {
    std::istringstream lines(_command.get_footer());
    bool begins = true;
    bool verbatim = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty()) {
        begins = true;
        continue;
      }
      if (begins && line.back() == ':') {
        if (verbatim) _out << ".fi\n";
        _out << ".SH " << upper(line.substr(0, line.size() - 1)) << "\n.nf\n";
        verbatim = true;
      } else {
        if (begins && !verbatim) _out << (_described ? ".PP\n" : ".SH DESCRIPTION\n");
        _described = _described || !verbatim;
        _out << plain(line) << '\n';
      }
      begins = false;
    }
    if (verbatim) _out << ".fi\n";
  }

  const CLI::App& _command;
  int _section;
  std::string _title;  // title of a section that is still empty
  bool _described = false;
  std::ostringstream _out;
};

}  // namespace

std::vector<Page> manual(const CLI::App& app, int section, const std::string& version) {
  std::vector<Page> pages;
  for (const CLI::App* command : with_all_below(app))
    pages.push_back(PageWriter(*command, section, version).page());
  return pages;
}

}  // namespace anticrack::guide
