#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "core/error.hpp"
#include "core/yaml_tree.hpp"
#include "tests/core/temporary_folder.hpp"

namespace {

using pellicle::InputError;
using namespace pellicle::core;
using Kind = YamlNode::Kind;

template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}
std::string parse_error(const std::string& text) {
  return error_of([&] { parse_yaml(text, "c.yaml"); });
}

TEST(YamlTree, KeepsPlacesAndOrder) {
  const YamlNode root = parse_yaml("b: 1\na:\n  - x\n  - {k: v,\n     l: [1, 2]}\nn:\n", "c.yaml");
  ASSERT_EQ(root.kind, Kind::map);
  ASSERT_EQ(root.members.size(), 3u);
  EXPECT_EQ(root.members[0].name, "b");
  EXPECT_EQ(root.find("b")->text, "1");
  EXPECT_EQ(root.find("b")->place, "c.yaml:1");
  const YamlNode& list = *root.find("a");
  EXPECT_EQ(list.place, "c.yaml:2");
  EXPECT_EQ(list.items[0].place, "c.yaml:3");
  EXPECT_EQ(list.items[1].find("k")->place, "c.yaml:4");
  EXPECT_EQ(list.items[1].find("l")->place, "c.yaml:5");
  EXPECT_EQ(list.items[1].find("l")->items[1].text, "2");
  EXPECT_EQ(root.find("n")->kind, Kind::null);
  EXPECT_EQ(root.find("missing"), nullptr);
}

TEST(YamlTree, AliasesAreReplaced) {
  const YamlNode root = parse_yaml("a: &box {min: 1}\nb: *box\n", "c.yaml");
  EXPECT_EQ(root.find("b")->find("min")->text, "1");
  EXPECT_EQ(root.find("b")->place, "c.yaml:2");
}

TEST(YamlTree, QuotedWordsAreNotNull) {
  const YamlNode root = parse_yaml("a: \"null\"\nb: null\nc: ~\n", "c.yaml");
  EXPECT_EQ(root.find("a")->kind, Kind::scalar);
  EXPECT_EQ(root.find("b")->kind, Kind::null);
  EXPECT_EQ(root.find("c")->kind, Kind::null);
}

TEST(YamlTree, RefusesWhatIsNotOneDocument) {
  EXPECT_EQ(parse_error("a: 1\nb:\n  c: 2\n  c: 3\n"),
            "c.yaml:4: b.c: given twice, first at c.yaml:3; each key may be given once");
  EXPECT_EQ(parse_error("a: [1, 2\nb: 3\n"),
            "c.yaml:2: not valid YAML: end of sequence flow not found; a YAML document");
  EXPECT_EQ(parse_error("a: 1\n---\nb: 2\n"), "c.yaml:3: more than one YAML document; one document");
  EXPECT_EQ(parse_error("? [1, 2]\n: 3\n"), "c.yaml:1: a list or section as a key; keys are plain names");
  EXPECT_EQ(parse_error("a: *unknown\n"),
            "c.yaml:1: not valid YAML: the referenced anchor is not defined; a YAML document");
  EXPECT_EQ(parse_error("x:\n  - a: 1\n    a: 2\n"),
            "c.yaml:3: x.0.a: given twice, first at c.yaml:2; each key may be given once");
}

TEST(YamlTree, RefusesAliasesThatGrow) {
  std::ostringstream text;
  text << "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i) {
    text << "a" << i << ": &a" << i << " [";
    for (int k = 0; k < 10; ++k) text << (k > 0 ? ", *a" : "*a") << i - 1;
    text << "]\n";
  }
  EXPECT_NE(parse_error(text.str()).find("aliases that grow without bounds"), std::string::npos);
}

TEST(YamlTree, UnreadableFiles) {
  const pellicle::tests::TemporaryFolder folder;
  const std::string missing = folder.path() / "none.yaml";
  EXPECT_EQ(error_of([&] { read_yaml_file(missing); }),
            missing + ": cannot be read: No such file or directory; a readable YAML file");
  EXPECT_EQ(error_of([&] { read_yaml_file(folder.path()); }),
            folder.path().string() + ": cannot be read: it is a folder; a readable YAML file");
  const std::string binary = folder.path() / "binary.yaml";
  std::ofstream(binary, std::ios::binary) << std::string("\x00\x01\xff\xfe{[\x80", 7);
  EXPECT_EQ(error_of([&] { read_yaml_file(binary); }),
            binary + ": cannot be read: it is no text; a readable YAML file");
}

class Overrides : public ::testing::Test {
 protected:
  YamlNode root = parse_yaml(
      "time: {end: 1}\noutput:\n  lines:\n    - {name: low, points: 3}\n    - {name: high, points: 4}\nlist: "
      "[1, 2]\n",
      "c.yaml");
  std::string error(const std::string& assignment) {
    return error_of([&] { apply_override(root, assignment); });
  }
};

TEST_F(Overrides, ReachKeysNamesAndIndices) {
  apply_override(root, "time.end=2 s");
  EXPECT_EQ(root.find("time")->find("end")->text, "2 s");
  EXPECT_EQ(root.find("time")->find("end")->place, "--set");
  apply_override(root, "output.lines.high.points=9");
  EXPECT_EQ(root.find("output")->find("lines")->items[1].find("points")->text, "9");
  EXPECT_EQ(root.find("output")->find("lines")->items[0].find("points")->text, "3");
  apply_override(root, "output.lines.0.points=7");
  EXPECT_EQ(root.find("output")->find("lines")->items[0].find("points")->text, "7");
  apply_override(root, "gas.grid.cells=[4, 5, 6]");
  EXPECT_EQ(root.find("gas")->find("grid")->find("cells")->items[2].text, "6");
  apply_override(root, "list=");
  EXPECT_EQ(root.find("list"), nullptr);
  apply_override(root, "output.lines.low=");
  ASSERT_EQ(root.find("output")->find("lines")->items.size(), 1u);
  EXPECT_EQ(root.find("output")->find("lines")->items[0].find("name")->text, "high");
  apply_override(root, "a.b=x=y");
  EXPECT_EQ(root.find("a")->find("b")->text, "x=y");
}

TEST_F(Overrides, Errors) {
  EXPECT_EQ(error("time.end"),
            "--set: \"time.end\" is not an assignment; path=value, such as time.end=\"2 s\"");
  EXPECT_EQ(error("=3"), "--set: \"=3\" is not an assignment; path=value, such as time.end=\"2 s\"");
  EXPECT_EQ(error("time..end=3"),
            "--set: \"time..end=3\" is not an assignment; path=value, such as time.end=\"2 s\"");
  EXPECT_EQ(error("output.lines.middle.points=3"),
            "--set: output.lines.middle: no such entry; 0 to 1, low, high");
  EXPECT_EQ(error("output.lines.2.points=3"), "--set: output.lines.2: no such entry; 0 to 1, low, high");
  EXPECT_EQ(error("time.end.x=3"),
            "--set: time.end.x: time.end is a value, not a section; the path of a key");
  EXPECT_EQ(error("time.end=[1, 2"),
            "--set: time.end: \"[1, 2\" is not valid YAML; a value such as 0.5, \"5 mm\" or [1, 2, 3]");
}

}  // namespace
