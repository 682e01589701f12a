#include "simulator/render/plain_words.hpp"

#include <gtest/gtest.h>

namespace ironbird::simulator {
namespace {

struct EngineMessage {
  const char* name;
  const char* says;
  const char* in_plain_words;
};

class PlainWordsTest : public ::testing::TestWithParam<EngineMessage> {};

TEST_P(PlainWordsTest, KeepWhatAPersonCanUse) {
  EXPECT_EQ(plain_words(GetParam().says), GetParam().in_plain_words);
}

// What MuJoCo 2.2 says, as it says it.
INSTANTIATE_TEST_SUITE_P(
    Messages, PlainWordsTest,
    ::testing::Values(
        EngineMessage{"Keyword", "XML Error: invalid keyword: 'bal'\nElement 'geom', line 0\n",
                      "invalid keyword: 'bal' in an element 'geom'"},
        EngineMessage{"Attribute",
                      "XML Error: Schema violation: unrecognized attribute: 'foo'\nElement 'geom', line 0\n",
                      "unrecognized attribute: 'foo' in an element 'geom'"},
        EngineMessage{"NamedObject",
                      "Error: invalid header in STL file '/m/bad.stl'\nObject name = hull, id = 0, line = 0, "
                      "column = -1",
                      "invalid header in STL file '/m/bad.stl', in 'hull'"},
        EngineMessage{
            "ObjectWithoutAName",
            "Error: material 'none' not found in geom 0\nObject name = , id = 0, line = 0, column = -1",
            "material 'none' not found in geom 0"},
        EngineMessage{"ObjectNamedBefore",
                      "Error: repeated name 'vehicle'\nObject name = vehicle, id = 2, line = 0, column = -1",
                      "repeated name 'vehicle'"},
        EngineMessage{
            "NoXml",
            "Include error: 'XML parse error 6:\nError=XML_ERROR_PARSING_ELEMENT ErrorID=6 (0x6) Line "
            "number=2\n'\nElement 'include', line 1\n",
            "is no well-formed XML: parsing element in line 2"},
        EngineMessage{
            "NothingAtAll",
            "Include error: 'XML parse error 13:\nError=XML_ERROR_EMPTY_DOCUMENT ErrorID=13 (0xd) Line "
            "number=0\n'\nElement 'include', line 1\n",
            "is no well-formed XML: empty document"},
        EngineMessage{
            "IncludeThatIsMissing",
            "Include error: 'XML parse error 3:\nError=XML_ERROR_FILE_NOT_FOUND ErrorID=3 (0x3) Line "
            "number=0: filename=/m/none.xml\n'\nElement 'include', line 1\n",
            "includes /m/none.xml, which is not there"}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace ironbird::simulator
