// SPDX-License-Identifier: GPL-3.0-or-later
//
// Options of the layers, completed from the configuration. Callbacks are not set.
#pragma once

#include "app/config.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/server.hpp"
#include "store/store.hpp"

namespace anticrack::app {

/// Throws ConfigError if the helper is not a program.
meshes::CatalogueOptions catalogue_options(const Config& config);
/// Throws ConfigError if it is another program, too.
void require_mesher(const Config& config);
rpc::ServerOptions server_options(const Config& config);
operators::OperatorCache::Factorise factorise_function(const Config& config);

}  // namespace anticrack::app
