#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gonio/fitting/model/parse_json.h>
#include <gonio/mapping/base/error.h>

namespace gonio {
namespace {

using testing::HasSubstr;

std::string error_of(const std::string& text) {
  try {
    parse_json(text, "a.json");
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

std::string nested(std::size_t depth, const std::string& open, const std::string& close) {
  std::string text;
  for (std::size_t k = 0; k < depth; ++k) text += open;
  text += "1";
  for (std::size_t k = 0; k < depth; ++k) text += close;
  return text;
}

TEST(ParseJson, GivesTheValue) {
  EXPECT_EQ(parse_json(R"({"a": [1, {"b": null}], "c": "d"})", "").dump(), R"({"a":[1,{"b":null}],"c":"d"})");
  EXPECT_EQ(parse_json(" 3 ", ""), 3);
}

TEST(ParseJson, NestingHasALimit) {
  for (const auto& [open, close] : {std::pair("[", "]"), std::pair("{\"a\":", "}")}) {
    EXPECT_EQ(error_of(nested(max_json_depth, open, close)), "none");
    for (const std::size_t depth : {max_json_depth + 1, std::size_t(100000), std::size_t(10000000)})
      EXPECT_EQ(error_of(nested(depth, open, "")),
                "a.json: found objects or arrays more than 64 deep, expected fewer inside each other");
  }
  EXPECT_EQ(error_of("[" + nested(max_json_depth - 1, "[", "]") + "," + nested(max_json_depth - 1, "[", "]") + "]"),
            "none");
}

TEST(ParseJson, EveryMemberOnce) {
  EXPECT_EQ(error_of(R"({"a": {"b": 1}, "b": [{"a": 1}, {"a": 2}]})"), "none");
  EXPECT_EQ(error_of(R"({"a": 1, "a": 1})"), "a.json: a: found twice, expected once");
  EXPECT_EQ(error_of(R"({"a": [0, {"b": {"c": 1, "d": {}, "c": 2}}]})"),
            "a.json: a[1].b.c: found twice, expected once");
  EXPECT_EQ(error_of(R"([[], {"x": 0, "\u0078": 1}])"), "a.json: [1].x: found twice, expected once");
}

TEST(ParseJson, SaysWhereItIsNoJson) {
  EXPECT_THAT(error_of(""), HasSubstr("a.json: is not JSON: parse error at line 1, column 1"));
  EXPECT_THAT(error_of("{\"a\":\n 1,}"), HasSubstr("a.json: is not JSON: parse error at line 2, column 4"));
  EXPECT_THAT(error_of("1e999"), HasSubstr("a.json: is not JSON: number overflow"));
  EXPECT_THAT(error_of("{} {}"), HasSubstr("a.json: is not JSON"));
  EXPECT_THAT(error_of("\"\xff\""), HasSubstr("a.json: is not JSON"));
  EXPECT_LT(error_of("[" + std::string(1000000, 'x')).size(), 300u);
  EXPECT_LT(error_of("{\"" + std::string(1000000, 'x') + "\":").size(), 300u);
  const std::string key = "\"" + std::string(1000, 'x') + "\":1";
  EXPECT_LT(error_of("{" + key + "," + key + "}").size(), 300u);
}

TEST(ParseJson, Utf16IsNamed) {
  EXPECT_THAT(error_of(std::string("\xff\xfe{\0}\0", 6)), HasSubstr("a.json: found UTF-16, expected JSON in UTF-8"));
  EXPECT_THAT(error_of(std::string("\xfe\xff\0{\0}", 6)), HasSubstr("found UTF-16"));
}

TEST(Shown, IsShortAndOfWholeCharacters) {
  EXPECT_EQ(shown({1, 2.5, "x"}), "[1,2.5,\"x\"]");
  const std::string long_text = shown(std::string(100, 'x'));
  EXPECT_EQ(long_text, "\"" + std::string(36, 'x') + "...");
  EXPECT_EQ(shown("x" + std::string(20, 'x') +
                  "\xf0\x9f\x98\x80\xf0\x9f\x98\x80\xf0\x9f\x98\x80\xf0\x9f\x98\x80\xf0\x9f\x98\x80"),
            "\"x" + std::string(20, 'x') + "\xf0\x9f\x98\x80\xf0\x9f\x98\x80\xf0\x9f\x98\x80...");
}

}  // namespace
}  // namespace gonio
