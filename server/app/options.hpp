// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configuration as the layers take it. Callbacks are left to whoever has something to call.
#pragma once

#include "app/config.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/server.hpp"
#include "store/store.hpp"

namespace anticrack::app {

/// The part of the configuration that each layer takes.
store::StoreOptions store_options(const Config& config);
/// Throws ConfigError where the helper is not a program.
meshes::CatalogueOptions catalogue_options(const Config& config);
jobs::EngineOptions engine_options(const Config& config);
rpc::ServerOptions server_options(const Config& config);
operators::OperatorCache::Factorise factorise_function(const Config& config);

}  // namespace anticrack::app
