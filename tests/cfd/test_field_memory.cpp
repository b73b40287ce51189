// The memory that large fields of the gas share.
#include <gtest/gtest.h>

#include "cfd/field_memory.hpp"

namespace pellicle::cfd {
namespace {

TEST(FieldMemory, FieldsAreZeroApartAndOutliveIt) {
  constexpr std::size_t large = 100'000;
  std::vector<HostArray<Real>> fields;
  HostArray<float> single;
  {
    FieldMemory memory;
    for (int i = 0; i < 60; ++i) {  // 48 MB: more than one allocation
      fields.push_back(make_field<Real>("tests::cfd::field", large));
      for (std::size_t c = 0; c < large; ++c) ASSERT_EQ(fields.back()(c), 0) << i;
      Kokkos::deep_copy(fields.back(), i + 1.0);
    }
    single = make_field<float>("tests::cfd::single", large);
    Kokkos::deep_copy(single, 7.0F);
    EXPECT_EQ(FieldMemory::current(), &memory);
  }
  EXPECT_EQ(FieldMemory::current(), nullptr);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    EXPECT_EQ(fields[i].extent(0), large);
    for (std::size_t c = 0; c < large; ++c) ASSERT_EQ(fields[i](c), static_cast<Real>(i) + 1);
  }
  for (std::size_t c = 0; c < large; ++c) ASSERT_EQ(single(c), 7.0F);
}

TEST(FieldMemory, SmallFieldsAndThoseWithoutItAreOnTheirOwn) {
  const auto alone = make_field<Real>("tests::cfd::alone", 1'000'000);
  EXPECT_EQ(alone.label(), "tests::cfd::alone");
  const FieldMemory memory;
  EXPECT_EQ(make_field<Real>("tests::cfd::small", 100).label(), "tests::cfd::small");
}

}  // namespace
}  // namespace pellicle::cfd
