// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/names.hpp"

#include <gtest/gtest.h>

#include "errors/errors.hpp"
#include "rpc/pages.hpp"
#include "rpc/refusals.hpp"

namespace anticrack::rpc {
namespace {

using api::job_id;
using api::job_name;
using api::mesh_id;
using api::mesh_name;
using api::upload_name;
using api::upload_sha256;
using errors::Error;

TEST(Names, AreReadBack) {
  EXPECT_EQ(mesh_id(mesh_name("0a1b"), "name"), "0a1b");
  EXPECT_EQ(job_id(job_name("x-1_2"), "name"), "x-1_2");
  const std::string hash(64, 'a');
  EXPECT_EQ(upload_sha256(upload_name(hash), "upload"), hash);
}

TEST(Names, OfOtherFormsAreRefusedWithTheField) {
  for (const char* name : {"", "meshes", "meshes/", "jobs/1", "meshes/..", "meshes/a/b",
                           "meshes/a b", "/meshes/a", "meshes/a\n"})
    expect_refused([&] { mesh_id(name, "job.mesh"); }, errors::Reason::invalid_argument,
                   "job.mesh");
  EXPECT_THROW(mesh_id("meshes/" + std::string(65, 'a'), "name"), Error);
  EXPECT_THROW(upload_sha256("uploads/" + std::string(63, 'a'), "upload"), Error);
  EXPECT_THROW(upload_sha256("uploads/" + std::string(64, 'A'), "upload"), Error);
}

TEST(Pages, HaveADefaultAndALimit) {
  EXPECT_EQ(to_page(0, "").size, default_page_size);
  EXPECT_EQ(to_page(1000, "abc").after, "abc");
  EXPECT_THROW(to_page(-1, ""), Error);
  EXPECT_THROW(to_page(1001, ""), Error);
  EXPECT_THROW(to_page(1, "../x"), Error);
}

}  // namespace
}  // namespace anticrack::rpc
