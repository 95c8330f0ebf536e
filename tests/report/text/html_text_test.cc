#include "report/text/html_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace vibrissa::report {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlText, EscapesWhatEndsATextOrAnAttribute) {
  EXPECT_EQ(html_escaped("<script>\"a\" & 'b'</script>"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;");
  EXPECT_EQ(html_escaped("&lt;"), "&amp;lt;");
  EXPECT_EQ(html_escaped("µN m²"), "µN m²");
  EXPECT_EQ(html_element("p", "a<b"), "<p>a&lt;b</p>\n");
}

TEST(HtmlText, JsonNeverEndsItsScriptAndReadsBack) {
  const nlohmann::json json{{"</script>", "<!--<script> & ]]> \\ \" \n"}};
  const std::string text = script_json(json);
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("<"), HasSubstr(">"), HasSubstr("&"))));
  EXPECT_EQ(nlohmann::json::parse(text), json);
}

TEST(HtmlText, JsonTakesBytesThatAreNoUtf8) {
  EXPECT_EQ(script_json(std::string("a\xff")), "\"a\xef\xbf\xbd\"");
}

}  // namespace
}  // namespace vibrissa::report
