// Key frames by their ids: what is kept, what is forgotten, what moves.
#include "textplane/landmarks/keyframe_store.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace keyframe_store_test {

using namespace textplane;

class KeyframeStoreTest : public testing::Test {
 protected:
  KeyframeStoreTest() {
    const std::vector<std::uint8_t> pixels(64, 9);
    for (const int id : {30, 10, 20, 40}) {
      auto own = std::make_unique<Pyramid>(ImageView8(pixels.data(), 8, 8), 1);
      TextKeyframe keyframe;
      keyframe.pyramid = *own;
      keyframe.T_w_c.t.x() = id;
      EXPECT_TRUE(store.add(id, keyframe, std::move(own)));
    }
  }
  KeyframeStore store;
};

TEST_F(KeyframeStoreTest, AnIdIsUsedOnce) {
  EXPECT_FALSE(store.add(10, TextKeyframe{}, nullptr));
  EXPECT_EQ(store.text_keyframe(10).T_w_c.t.x(), 10);
  EXPECT_FALSE(store.has(11));
  EXPECT_EQ(store.text_keyframe(11).pyramid.levels, 0);
}

TEST_F(KeyframeStoreTest, TheOldestImagesGoAndNeededPosesStay) {
  EXPECT_EQ(store.bytes(), 4U * 64);
  store.forget_oldest(4, [](int) { return false; });
  EXPECT_EQ(store.size(), 4U) << "no more than asked for";
  store.forget_oldest(2, [](int id) { return id == 10; });
  EXPECT_EQ(store.size(), 3U);
  EXPECT_EQ(store.bytes(), 2U * 64);
  EXPECT_TRUE(store.has(10) && !store.has_image(10));
  EXPECT_FALSE(store.has(20));
  EXPECT_TRUE(store.has_image(30) && store.has_image(40));
  store.forget_oldest(2, [](int) { return false; });
  EXPECT_FALSE(store.has(10)) << "no longer needed";
}

TEST_F(KeyframeStoreTest, APoseThatIsNotFiniteMovesNothing) {
  store.move([](int id) {
    SE3d T_c_w;
    T_c_w.t.x() = id == 20 ? std::nan("") : 1;
    return T_c_w;
  });
  EXPECT_EQ(store.text_keyframe(20).T_w_c.t.x(), 20);
  EXPECT_EQ(store.text_keyframe(30).T_w_c.t.x(), -1) << "the inverse of world to camera";
}

}  // namespace keyframe_store_test
