// SPDX-License-Identifier: GPL-3.0-or-later
//
// Resource names ("meshes/ID") and their ids. Functions that read a name throw errors::Error
// (invalid_argument) with `field` at fault.
#pragma once

#include <string>
#include <string_view>

namespace anticrack::api {

/// The resource name of an id.
std::string mesh_name(const std::string& id);
std::string job_name(const std::string& id);
std::string upload_name(const std::string& sha256);

/// The id in a resource name.
std::string mesh_id(const std::string& name, std::string_view field);
std::string job_id(const std::string& name, std::string_view field);
/// The sha256 of "uploads/SHA256".
std::string upload_sha256(const std::string& name, std::string_view field);

/// The part after the '/' of a name that was checked before.
std::string after_slash(const std::string& name, std::string_view field);

/// Whether a text is an id: 1 to 64 letters, digits, '-' and '_'.
bool is_id(std::string_view text) noexcept;

}  // namespace anticrack::api
