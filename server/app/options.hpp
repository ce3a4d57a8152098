// SPDX-License-Identifier: GPL-3.0-or-later
//
// The configuration as options of the layers. Callbacks are not set.
#pragma once

#include "app/config.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/server.hpp"
#include "store/store.hpp"

namespace anticrack::app {

store::StoreOptions store_options(const Config& config);
/// Throws ConfigError if the helper is not a program.
meshes::CatalogueOptions catalogue_options(const Config& config);
jobs::EngineOptions engine_options(const Config& config);
rpc::ServerOptions server_options(const Config& config);
operators::OperatorCache::Factorise factorise_function(const Config& config);

}  // namespace anticrack::app
