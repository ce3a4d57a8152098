// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/case.hpp"

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "cli/text.hpp"
#include "client/jobs.hpp"
#include "words/nearest_field.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

/// Refuses a text above the server's limit, for which it asks only if the text is large.
void check_size(Session& session, const fs::path& path) {
  constexpr std::uintmax_t near = 1 << 20;
  std::error_code none;  // set for a pipe
  const std::uintmax_t size = fs::file_size(path, none);
  if (none || size < near) return;
  const std::uint32_t most =
      client::server_info(session.connection(), session.stop()).limits().message_bytes();
  if (size < most) return;
  throw CaseError(path.string(), "its " + bytes(size) + " are more than the server takes, " +
                                     bytes(most) +
                                     "; write fewer points, or the mesh in a .msh file");
}

std::string text_of(const fs::path& path) {
  constexpr const char* cure = "; name a case, a TOML file";
  if (fs::is_directory(path)) throw CaseError(path.string(), std::string("is a folder") + cure);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  // Inserting an empty file fails too; the server says what it lacks.
  if (!(text << file.rdbuf()) && (!fs::is_regular_file(path) || !file)) {
    const std::string reason = errno == 0 ? "" : ": " + std::generic_category().message(errno);
    throw CaseError(path.string(), "cannot be read" + reason + cure);
  }
  return text.str();
}

Case case_of(Session& session, const v1::ReadCaseRequest& request, const fs::path& folder) {
  v1::ReadCaseResponse read;
  try {
    read = client::read_case(session.connection(), request, session.stop());
  } catch (const client::Error& error) {
    if (error.details().reason == "CASE_INVALID") throw CaseError(error.what());
    throw;
  }
  Case made;
  made.text = read.toml().empty() ? request.toml() : read.toml();
  if (!read.mesh_file().empty()) made.mesh_file = folder / read.mesh_file();
  made.mesh = std::move(*read.mutable_mesh());
  made.spec = std::move(*read.mutable_spec());
  for (const v1::CaseArray& array : read.arrays())
    made.force_files.push_back({array.load_case(), folder / array.file(), array.dataset()});
  made.notes.assign(read.notes().begin(), read.notes().end());
  made.places.insert(read.places().begin(), read.places().end());
  return made;
}

}  // namespace

const v1::CasePlace* Case::locate(const std::string& field) const {
  return words::nearest_field(places, field);
}

std::string told(const v1::CasePlace& place) {
  if (place.where().empty()) return place.key();
  return place.key().empty() ? place.where() : place.where() + ": " + place.key();
}

Case read_case(Session& session, const fs::path& path, const std::vector<std::string>& overrides,
               Loads loads, const std::vector<std::string>& only) {
  check_size(session, path);
  v1::ReadCaseRequest request;
  request.set_toml(text_of(path));
  request.set_source(sanitise(path.string()));
  request.mutable_overrides()->Add(overrides.begin(), overrides.end());
  request.mutable_loads()->Add(only.begin(), only.end());
  request.set_loads_optional(loads == Loads::optional);
  return case_of(session, request, path.parent_path());
}

Case msh_case(Session& session, const fs::path& file, const std::string& title,
              const std::vector<std::string>& overrides) {
  v1::ReadCaseRequest request;
  request.set_msh(sanitise(file.string()));
  request.mutable_overrides()->Add(overrides.begin(), overrides.end());
  Case made = case_of(session, request, "");
  made.mesh.set_title(title);
  made.mesh_file = file;  // a name need not be UTF-8
  return made;
}

}  // namespace anticrack::cli
