#include "report/report_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fresco {
namespace {

TEST(ReportHtml, HtmlKeepsNoCharacterThatEndsATextOrAnAttribute) {
  EXPECT_EQ(EscapedHtml("R < 100 m & \"x\" > 'y'"), "R &lt; 100 m &amp; &quot;x&quot; &gt; &#39;y&#39;");
  EXPECT_EQ(EscapedHtml("σ², 5 °C"), "σ², 5 °C");
}

TEST(ReportHtml, JsonHasNoTagAndStillSaysTheSame) {
  const nlohmann::json json = {{"name", "</script><!-- <b> & \\"}, {"values", {1, 2.5}}};
  const std::string escaped = EscapedJson(json.dump());
  EXPECT_THAT(escaped, testing::Not(testing::HasSubstr("<")));
  EXPECT_EQ(nlohmann::json::parse(escaped), json);
}

// RFC 3986, sections 2.1 and 2.3.
TEST(ReportHtml, PercentEncodingLeavesTheUnreservedCharactersOnly) {
  EXPECT_EQ(PercentEncoded("az-AZ_09.~"), "az-AZ_09.~");
  EXPECT_EQ(PercentEncoded("<a b=\"#%\">"), "%3Ca%20b%3D%22%23%25%22%3E");
  EXPECT_EQ(PercentEncoded("σ"), "%CF%83");
}

TEST(ReportHtml, ATemplateIsFilledOnce) {
  EXPECT_EQ(FilledTemplate("<{{a}}|{{b}}|{{a}}>", {{"a", "{{b}}"}, {"b", "2"}}), "<{{b}}|2|{{b}}>");
  EXPECT_EQ(FilledTemplate("", {}), "");
  EXPECT_EQ(FilledTemplate("no name {", {}), "no name {");
}

TEST(ReportHtmlDeathTest, ATemplateWithAnUnknownNameIsAProgrammersError) {
  EXPECT_DEATH(FilledTemplate("{{c}}", {{"a", ""}}), "part != parts.end");
  EXPECT_DEATH(FilledTemplate("{{a", {{"a", ""}}), "npos");
}

}  // namespace
}  // namespace fresco
