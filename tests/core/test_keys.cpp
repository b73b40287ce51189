#include <gtest/gtest.h>

#include <string>

#include "core/error.hpp"
#include "core/key_catalogue.hpp"
#include "core/key_reader.hpp"
#include "core/key_writer.hpp"
#include "core/keys.hpp"

namespace {

using namespace pellicle;
using namespace pellicle::core;

constexpr ModelInfo colours[] = {{"red", "like blood"}, {"green", "like grass"}, {"blue", "like the sky"}};
enum class Colour { red, green, blue };

struct Ball {
  std::string name;
  Real diameter = 0;
  std::optional<Real> mass;
};

/// One key of each kind.
struct Everything {
  Real length = 0.5;
  std::int64_t count = 3;
  bool flag = false;
  std::string text = "as is";
  Colour colour = Colour::green;
  std::string colour_name = "blue";
  bool mark = false;
  Vec3 vector{0, 0, -9.81};
  Index3 counts{1, 2, 3};
  std::vector<Real> reals{1, 2};
  std::vector<std::string> names{"a", "b"};
  std::vector<Colour> colours{Colour::red};
  Ball section;
  std::optional<Ball> maybe;
  std::vector<Ball> balls;
  std::vector<Ball> named;
};

void describe_ball(Keys& keys, Ball& ball) {
  keys.real({"diameter", "of the ball", Need::required}, {dimension::length, range::positive}, ball.diameter);
  keys.real({"mass", "of the ball"}, {dimension::mass, range::positive}, ball.mass);
}

void describe(Keys& keys, Everything& e) {
  keys.real({"length", "a length"}, {dimension::length, {.min = 0, .max = 2, .max_excluded = true}},
            e.length);
  keys.whole({"count", "a number"}, {1, 10}, e.count);
  keys.flag({"flag", "yes or no"}, e.flag);
  keys.text({"text", "anything"}, TextRule::any, e.text);
  keys.choice({"colour", "one"}, colours, e.colour);
  keys.choice({"colour_name", "one"}, colours, e.colour_name);
  keys.mark({"mark", "there or not"}, e.mark);
  keys.vector({"vector", "three"}, {dimension::acceleration}, e.vector);
  keys.counts({"counts", "three"}, {1, 100}, e.counts);
  keys.reals({"reals", "some"}, {dimension::length}, Size{1, 3}, e.reals);
  keys.texts({"names", "two"}, TextRule::name, Size::exactly(2), e.names);
  keys.choices({"colours", "some"}, colours, {}, e.colours);
  keys.section<Ball>({"section", "a ball"}, e.section, [](Keys& k, Ball& ball) {
    k.real({"diameter", "of the ball"}, {dimension::length}, ball.diameter);
  });
  keys.section<Ball>({"maybe", "a ball or none"}, e.maybe, describe_ball);
  keys.list<Ball>({"balls", "any number"}, {}, e.balls, [](Keys& k, Ball& ball) {
    k.text({"name", "of the ball"}, TextRule::name, ball.name);
    describe_ball(k, ball);
  });
  keys.named<Ball>({"named", "by name"}, e.named, describe_ball);
}

struct ReadResult {
  Everything value;
  std::vector<std::string> problems;
  std::map<std::string, std::string> places;
};

ReadResult read(const std::string& text) {
  ReadResult result;
  InputProblems problems;
  const YamlNode root = parse_yaml(text, "c.yaml");
  read_keys(
      root, [&](Keys& keys) { describe(keys, result.value); }, problems, result.places);
  result.problems = problems.messages();
  return result;
}

/// The only problem of a text.
std::string problem(const std::string& text) {
  const auto result = read(text);
  EXPECT_EQ(result.problems.size(), 1u) << text;
  return result.problems.empty() ? "none" : result.problems.front();
}

TEST(KeyReader, NothingGivenLeavesDefaults) {
  const auto result = read("{}");
  EXPECT_TRUE(result.problems.empty());
  EXPECT_EQ(result.value.length, 0.5);
  EXPECT_EQ(result.value.colour, Colour::green);
  EXPECT_FALSE(result.value.maybe.has_value());
  EXPECT_TRUE(result.places.empty());
}

TEST(KeyReader, ReadsEveryKind) {
  const auto result = read(R"(
length: 5 mm
count: 1e1
flag: true
text: "true"
colour: blue
colour_name: red
vector: [0, 0, "-981 cm/s2"]
counts: [4, 5, 6]
reals: [1 cm, 2, 0.3]
names: [x, y-1]
colours: [blue, red]
section: {diameter: 2}
maybe: {diameter: 3 mm, mass: 1 g}
balls:
  - {name: one, diameter: 1}
  - diameter: 2
named:
  first: {diameter: 7}
)");
  ASSERT_TRUE(result.problems.empty()) << result.problems.front();
  const Everything& e = result.value;
  EXPECT_EQ(e.length, 0.005);
  EXPECT_EQ(e.count, 10);
  EXPECT_TRUE(e.flag);
  EXPECT_EQ(e.text, "true");
  EXPECT_EQ(e.colour, Colour::blue);
  EXPECT_EQ(e.colour_name, "red");
  EXPECT_DOUBLE_EQ(e.vector.z, -9.81);
  EXPECT_EQ(e.counts.y, 5);
  EXPECT_EQ(e.reals, (std::vector<Real>{0.01, 2, 0.3}));
  EXPECT_EQ(e.names, (std::vector<std::string>{"x", "y-1"}));
  EXPECT_EQ(e.colours, (std::vector<Colour>{Colour::blue, Colour::red}));
  EXPECT_EQ(e.section.diameter, 2);
  EXPECT_EQ(*e.maybe->mass, 0.001);
  EXPECT_EQ(e.balls.size(), 2u);
  EXPECT_EQ(e.balls[1].diameter, 2);
  EXPECT_EQ(e.named[0].name, "first");
  EXPECT_EQ(result.places.at("balls.one.diameter"), "c.yaml:16");
  EXPECT_EQ(result.places.at("balls.1.diameter"), "c.yaml:17");
  EXPECT_EQ(result.places.at("named.first"), "c.yaml:19");
}

TEST(KeyReader, Marks) {
  EXPECT_TRUE(read("mark: {}").value.mark);
  EXPECT_TRUE(read("mark:").value.mark);
  EXPECT_EQ(problem("mark: true"), "c.yaml:1: mark: it takes no values; mark: {}");
}

TEST(KeyReader, EmptySectionsAndLists) {
  EXPECT_TRUE(read("section:\nballs:\nnamed:\n").problems.empty());
  EXPECT_EQ(problem("maybe:"), "c.yaml:1: maybe.diameter: missing; a length greater than 0");
}

TEST(KeyReader, UnknownKeys) {
  EXPECT_EQ(problem("section:\n  diametre: 3"),
            "c.yaml:2: section.diametre: unknown key, the nearest is diameter; known here: diameter");
  EXPECT_EQ(problem("lenght: 3").substr(0, 56), "c.yaml:1: lenght: unknown key, the nearest is length; kn");
  EXPECT_EQ(problem("balls: [{diameter: 1, nmae: x}]"),
            "c.yaml:1: balls.0.nmae: unknown key, the nearest is name; known here: name, diameter, mass");
}

TEST(KeyReader, WrongTypes) {
  EXPECT_EQ(problem("length: [1]"),
            "c.yaml:1: length: a list is given where a single value is expected; a number "
            "in m or a string such as \"5 mm\"");
  EXPECT_EQ(problem("length: {a: 1}"),
            "c.yaml:1: length: a section is given where a single value is expected; a "
            "number in m or a string such as \"5 mm\"");
  EXPECT_EQ(problem("length:"),
            "c.yaml:1: length: nothing is given where a single value is expected; a number in m or "
            "a string such as \"5 mm\"");
  EXPECT_EQ(problem("count: 3.5"),
            "c.yaml:1: count: \"3.5\" is not a whole number; a whole number from 1 to 10");
  EXPECT_EQ(problem("count: many"),
            "c.yaml:1: count: \"many\" is not a whole number; a whole number from 1 to 10");
  EXPECT_EQ(problem("flag: yes"), "c.yaml:1: flag: \"yes\" is neither true nor false; true or false");
  EXPECT_EQ(problem("names: [a, \"b c\"]"),
            "c.yaml:1: names.1: \"b c\" is no name; a name of letters, digits, _ and -");
  EXPECT_EQ(problem("section: 3"),
            "c.yaml:1: section: a single value is given where a section is expected; keys with values");
  EXPECT_EQ(problem("balls: 3"),
            "c.yaml:1: balls: a single value is given where a list is expected; a list of "
            "sections, each starting with -");
  EXPECT_EQ(problem("balls: [3]"),
            "c.yaml:1: balls.0: a single value is given where a section is expected; keys with values");
  EXPECT_EQ(problem("named: {\"a b\": {diameter: 1}}"),
            "c.yaml:1: named.a b: \"a b\" is no name; a name of letters, digits, _ and -");
  EXPECT_EQ(problem("[1, 2]"), "c.yaml:1: a list is given where a section is expected; keys with values");
  EXPECT_EQ(problem("vector: 3"),
            "c.yaml:1: vector: a single value is given where a list is expected; a list of 3 "
            "entries, each a number in m/s2 or a string such as \"981 cm/s2\"");
}

TEST(KeyReader, WrongUnitsAndRanges) {
  EXPECT_EQ(problem("length: 3 kg"),
            "c.yaml:1: length: \"3 kg\" is not a length; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(problem("length: -1 mm"),
            "c.yaml:1: length: \"-1 mm\" is out of range; a length at least 0 and less than 2 m");
  EXPECT_EQ(problem("length: 2"),
            "c.yaml:1: length: \"2\" is out of range; a length at least 0 and less than 2 m");
  EXPECT_EQ(problem("maybe: {diameter: 0}"),
            "c.yaml:1: maybe.diameter: \"0\" is out of range; a length greater than 0");
  EXPECT_EQ(problem("count: 11"), "c.yaml:1: count: \"11\" is out of range; a whole number from 1 to 10");
  EXPECT_EQ(problem("counts: [1, 0, 1]"),
            "c.yaml:1: counts.1: \"0\" is out of range; a whole number from 1 to 100");
  EXPECT_EQ(problem("vector: [0, 0, 1 m]"),
            "c.yaml:1: vector.2: \"1 m\" is not an acceleration; a number in m/s2 or "
            "a string such as \"981 cm/s2\"");
}

TEST(KeyReader, WrongSizes) {
  EXPECT_EQ(problem("vector: [0, 1]"),
            "c.yaml:1: vector: the list has 2 entries; a list of 3 entries, each a number "
            "in m/s2 or a string such as \"981 cm/s2\"");
  EXPECT_EQ(problem("reals: []"),
            "c.yaml:1: reals: the list has 0 entries; a list of 1 to 3 entries, each a number in "
            "m or a string such as \"5 mm\"");
}

TEST(KeyReader, ChoicesSayWhatThereIs) {
  EXPECT_EQ(problem("colour: gren"),
            "c.yaml:1: colour: \"gren\" is unknown, the nearest is green; red, green, blue");
  EXPECT_EQ(problem("colours: [red, bleu]"),
            "c.yaml:1: colours.1: \"bleu\" is unknown, the nearest is blue; red, green, blue");
}

TEST(KeyReader, AlternativesAndMissingKeys) {
  EXPECT_EQ(problem("maybe:\n  mass: 3"), "c.yaml:1: maybe.diameter: missing; a length greater than 0");
  Real a = 0, b = 0;
  const auto exactly_one = [&](const std::string& text) {
    InputProblems problems;
    std::map<std::string, std::string> places;
    read_keys(
        parse_yaml(text, "c.yaml"),
        [&](Keys& keys) {
          keys.real({"a", ""}, {}, a);
          keys.real({"b", ""}, {}, b);
          keys.exactly_one({"a", "b"});
        },
        problems, places);
    return problems.empty() ? "" : problems.messages().front();
  };
  EXPECT_EQ(exactly_one("{}"), "c.yaml:1: none is given; exactly one of a, b");
  EXPECT_EQ(exactly_one("{a: 1, b: 2}"), "c.yaml:1: a and b are given; exactly one of a, b");
  EXPECT_EQ(exactly_one("{a: 1}"), "");
}

TEST(KeyReader, AllProblemsAreReported) {
  const auto result = read("length: x\ncount: 0\ncolour: pink\n");
  ASSERT_EQ(result.problems.size(), 3u);
  InputProblems problems;
  problems.add("c.yaml:1: a", "wrong; right");
  problems.add("c.yaml:2: b", "bad; good");
  try {
    problems.throw_if_any();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "c.yaml:1: a: wrong; right\nc.yaml:2: b: bad; good");
  }
}

// What is written reads back to the same values, to the bit, whatever the values are.
TEST(KeyWriter, RoundTrip) {
  Everything e;
  e.length = 0.1 + 0.2;
  e.count = 7;
  e.flag = true;
  e.text = "a \"quoted\" text: # with\nlines\tand \\ ";
  e.colour = Colour::red;
  e.vector = {1e-300, -1.0 / 3, 12345678.9};
  e.reals = {1e-5};
  e.maybe = Ball{"", 3e-3, 1.5};
  e.balls = {{"one", 1, std::nullopt}, {"two", 2, 4e-9}};
  e.named = {{"x", 1, 2.0}, {"y-2", 3, std::nullopt}};
  const std::string text = write_keys([&](Keys& keys) { describe(keys, e); });
  auto result = read(text);
  ASSERT_TRUE(result.problems.empty()) << result.problems.front() << "\n" << text;
  EXPECT_EQ(write_keys([&](Keys& keys) { describe(keys, result.value); }), text);
  EXPECT_EQ(result.value.length, e.length);
  EXPECT_EQ(result.value.text, e.text);
  EXPECT_EQ(result.value.vector, e.vector);
  EXPECT_EQ(result.value.balls[1].mass, e.balls[1].mass);
  EXPECT_EQ(result.value.named[1].name, "y-2");
}

TEST(KeyWriter, TextsThatLookLikeSomethingElse) {
  EXPECT_EQ(to_yaml(std::string("plain text")), "plain text");
  for (const std::string text :
       {"true", "null", "", " x", "x ", "1", "-", "~", "a: b", "a #b", "[x]", "yes", "x\x01"}) {
    Everything e;
    e.text = text;
    const std::string yaml = write_keys([&](Keys& keys) { describe(keys, e); });
    const auto result = read(yaml);
    ASSERT_TRUE(result.problems.empty()) << text << ": " << result.problems.front();
    EXPECT_EQ(result.value.text, text);
  }
}

TEST(KeyCatalogue, SaysWhatWasDeclared) {
  const KeyInfo root = catalogue_keys([](Keys& keys) {
    Everything e;
    describe(keys, e);
  });
  ASSERT_EQ(root.children.size(), 16u);
  const auto find = [&](const std::string& name) {
    for (const auto& key : root.children) {
      if (key.name == name) return key;
    }
    return KeyInfo{};
  };
  EXPECT_EQ(find("length").default_text, "0.5");
  EXPECT_EQ(find("length").type, KeyType::real);
  EXPECT_EQ(find("length").real_rule.range.max, 2);
  EXPECT_EQ(find("colour").default_text, "green");
  EXPECT_EQ(find("colour").allowed.size(), 3u);
  EXPECT_EQ(find("vector").default_text, "[0, 0, -9.81]");
  EXPECT_TRUE(find("vector").is_list);
  EXPECT_EQ(find("colours").default_text, "[red]");
  EXPECT_TRUE(find("balls").is_list);
  EXPECT_EQ(find("balls").children.size(), 3u);
  EXPECT_TRUE(find("named").is_named);
  EXPECT_EQ(find("maybe").children.front().need, Need::required);
}

TEST(Keys, NearestName) {
  EXPECT_EQ(nearest_name("particls", {"walls", "particles", "gas"}), "particles");
  EXPECT_EQ(nearest_name("Gas", {"walls", "gas"}), "gas");
  EXPECT_EQ(nearest_name("gsa_step", {"particle_step", "gas_step"}), "gas_step");
  EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
