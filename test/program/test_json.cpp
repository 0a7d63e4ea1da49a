// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <gtest/gtest.h>
#include <boost/property_tree/json_parser.hpp>

#include <limits>
#include <sstream>

#include "support/json.h"

namespace segorient::test {
namespace {

TEST(Json, IsReadByAnotherParser) {
  program::JsonWriter json;
  json.field("text", "a \"quote\", a \\ and a\nline");
  json.field("count", std::size_t{18446744073709551615U});
  json.field("share", 0.25);
  json.field("nan", std::numeric_limits<double>::quiet_NaN());
  json.field("yes", true);
  json.beginObject("empty");
  json.endObject();
  json.beginArray("items");
  json.beginItem();
  json.field("a", 1);
  json.endObject();
  json.beginItem();
  json.field("a", 2);
  json.endObject();
  json.endArray();
  std::istringstream in(json.finish());
  boost::property_tree::ptree tree;
  ASSERT_NO_THROW(boost::property_tree::read_json(in, tree));
  EXPECT_EQ(tree.get<std::string>("text"), "a \"quote\", a \\ and a\nline");
  EXPECT_EQ(tree.get<std::string>("count"), "18446744073709551615");
  EXPECT_EQ(tree.get<double>("share"), 0.25);
  EXPECT_EQ(tree.get<std::string>("nan"), "null");
  EXPECT_TRUE(tree.get<bool>("yes"));
  EXPECT_EQ(tree.get_child("items").size(), 2U);
  EXPECT_EQ(tree.get_child("items").back().second.get<int>("a"), 2);
}

}  // namespace
}  // namespace segorient::test
