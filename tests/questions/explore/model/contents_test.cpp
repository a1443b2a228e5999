// SPDX-License-Identifier: Apache-2.0
// What is in flight in a channel: who overtakes whom.
#include "explore/model/contents.hpp"

#include <gtest/gtest.h>

namespace takt::explore {
namespace {

Content of(std::initializer_list<WordId> words) {
  Content content;
  for (const WordId word : words) content.push(word);
  return content;
}

TEST(Content, IsHeardInTurn) {
  Content content = of({1, 2, 3});
  EXPECT_EQ(content.take(*content.next()).word, 1);
  EXPECT_EQ(content.take(*content.next()).word, 2);
  EXPECT_EQ(content, of({3}));
}

TEST(Content, WhoStraysIsOvertaken) {
  Content content = of({1, 2});
  content[0].strays = true;
  EXPECT_EQ(*content.next(), 1U);
  EXPECT_FALSE(content[0].overtaken);
  EXPECT_FALSE(content.take(1).overtaken);
  EXPECT_FALSE(content.next());
  EXPECT_TRUE(content.take(0).overtaken);
  EXPECT_EQ(content, Content{});
}

TEST(Content, WhatWasOvertakenOvertakesNobody) {
  Content content = of({1, 2, 3});
  content[0].strays = content[1].strays = true;
  content.take(2);
  EXPECT_TRUE(content.take(1).overtaken);
  EXPECT_TRUE(content[0].overtaken);
}

TEST(Content, ACopyAndItsOriginalDoNotOvertakeEachOther) {
  Content content = of({1, 2});
  content.copy(0);
  ASSERT_EQ(content.size(), 3U);
  EXPECT_EQ(content.take(*content.next()).word, 1);  // the original
  EXPECT_FALSE(content[0].overtaken);
  EXPECT_FALSE(content[0].twin);
  EXPECT_EQ(content.take(*content.next()).word, 2);
  EXPECT_TRUE(content[0].overtaken);  // the copy
}

TEST(Content, ACopyOfWhatIsLostStaysACopyOfNobody) {
  Content content = of({1, 2});
  content.copy(0);
  content.remove(1);
  EXPECT_FALSE(content[0].twin);
  content.take(1);
  EXPECT_TRUE(content[0].overtaken);
}

TEST(Content, EqualContentsAreOneNumber) {
  Query query;
  query.slaves = 2;
  const Renamings renamings(2, true);
  Members members(query, renamings);
  Contents contents(members, renamings);
  EXPECT_EQ(contents.intern(Content{}), Contents::empty);
  const WordId word = members[members.fresh(1, 1)].word;
  EXPECT_EQ(contents.intern(of({word})), contents.intern(of({word})));
  EXPECT_NE(contents.intern(of({word})), contents.intern(of({word, word})));
}

}  // namespace
}  // namespace takt::explore
