// SPDX-License-Identifier: Apache-2.0
// Instance data judged by libyang, with a module of the test's own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "interchange/yang/validate.hpp"

namespace takt::interchange::test {
namespace {

class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / ("takt-yang-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
  }
  std::string path(const std::string& part = "") const { return (path_ / part).string(); }

 private:
  std::filesystem::path path_;
};

constexpr const char* module = R"(module ietf-interfaces {
  yang-version 1.1;
  namespace "urn:ietf:params:xml:ns:yang:ietf-interfaces";
  prefix if;
  revision 2018-02-20;
  container interfaces { list interface { key "name"; leaf name { type string { length "1..4"; } } } }
}
)";
std::string json_of(const std::string& name) {
  return R"({"ietf-interfaces:interfaces": {"interface": [{"name": ")" + name + "\"}]}}";
}
std::string xml_of(const std::string& name) {
  return "<interfaces xmlns=\"urn:ietf:params:xml:ns:yang:ietf-interfaces\"><interface><name>" + name +
         "</name></interface></interfaces>";
}

TEST(YangValidation, SaysWhatLibyangSays) {
  if (!can_validate_yang()) GTEST_SKIP() << "built without libyang";
  const Folder folder;
  folder.write("plain/ietf-interfaces@2018-02-20.yang", module);
  folder.write("parts/ietf/ietf-interfaces@2018-02-20.yang", module);
  for (const char* const part : {"plain", "parts"}) {
    const std::vector<OutputFile> files = {{"a.json", json_of("eth0"), false},
                                           {"b.json", json_of("ethernet0"), false},
                                           {"c.xml", xml_of("eth0"), false},
                                           {"d.xml", xml_of("ethernet0"), false},
                                           {"takt.names.json", "{}", false}};
    const YangValidation found = validate_yang(files, false, folder.path(part));
    EXPECT_EQ(found.mistake, "");
    ASSERT_EQ(found.invalid.size(), 2u) << part;
    EXPECT_TRUE(found.invalid[0].starts_with("b.json: ")) << found.invalid[0];
    EXPECT_NE(found.invalid[0].find("length"), std::string::npos) << found.invalid[0];
    EXPECT_TRUE(found.invalid[1].starts_with("d.xml: ")) << found.invalid[1];
  }
}

TEST(YangValidation, TellsWhichModuleIsMissing) {
  if (!can_validate_yang()) GTEST_SKIP() << "built without libyang";
  const Folder folder;
  const std::vector<OutputFile> files = {{"a.json", json_of("eth0"), false}};
  EXPECT_NE(validate_yang(files, true, folder.path()).mistake.find("module ietf-interfaces"), std::string::npos);
  EXPECT_NE(validate_yang(files, true, folder.path("nowhere")).mistake.find("expected a folder"), std::string::npos);
}

}  // namespace
}  // namespace takt::interchange::test
