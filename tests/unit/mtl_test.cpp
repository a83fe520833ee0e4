#include "client/mesh_file/mtl.h"

#include "client/mesh_file/formats.h"
#include "client/mesh_file/obj_file.h"
#include "tests/support/mesh_file_fixture.h"

namespace papilio::client {
namespace {

using Color = std::array<double, 3>;

MtlMaterial only_material(const std::string& lines) {
  const std::vector<MtlMaterial> materials = parse_mtl("newmtl a\n" + lines + "\n");
  EXPECT_EQ(materials.size(), 1U);
  return materials.at(0);
}

std::string mtl_complaint(std::string_view bytes) {
  try {
    (void)parse_mtl(bytes);
    return "";
  } catch (const ParseError& error) {
    return error.what();
  }
}

TEST(Mtl, ValuesAreRead) {
  const MtlMaterial material =
      only_material("Kd 0.1 .2 3e-1\nd 0.5\nKe 4 5 6\nNs 96\nPr 0.25\nPm 1\nillum 2\nTf 1 1 1");
  EXPECT_EQ(material.name, "a");
  EXPECT_EQ(material.diffuse, (Color{0.1, 0.2, 0.3}));
  EXPECT_EQ(material.opacity, 0.5);
  EXPECT_EQ(material.emissive, (Color{4, 5, 6}));
  EXPECT_EQ(material.shininess, 96);
  EXPECT_EQ(material.roughness, 0.25);
  EXPECT_EQ(material.metallic, 1);
}

TEST(Mtl, AbsentValuesStayAbsent) { EXPECT_EQ(only_material(""), MtlMaterial{.name = "a"}); }

TEST(Mtl, OneNumberIsAGray) { EXPECT_EQ(only_material("Kd 0.5 # all").diffuse, (Color{0.5, 0.5, 0.5})); }

TEST(Mtl, SpectralAndXyzColorsAreSkipped) {
  EXPECT_FALSE(only_material("Kd spectral file.rfl 1").diffuse);
  EXPECT_FALSE(only_material("Kd xyz 1 1 1").diffuse);
}

TEST(Mtl, FactorsAreClamped) {
  const MtlMaterial material = only_material("Kd 2 -1 0.5\nd 7\nPm -3\nNs -1");
  EXPECT_EQ(material.diffuse, (Color{1, 0, 0.5}));
  EXPECT_EQ(material.opacity, 1);
  EXPECT_EQ(material.metallic, 0);
  EXPECT_EQ(material.shininess, 0);
}

TEST(Mtl, TransparencyIsTheComplementOfOpacity) {
  EXPECT_EQ(only_material("Tr 0.25").opacity, 0.75);
  EXPECT_EQ(only_material("d 0.5\nTr 1").opacity, 0.5);
  EXPECT_EQ(only_material("Tr 1\nd -halo 0.5").opacity, 0.5);
}

TEST(Mtl, MapOptionsAreSkipped) {
  for (const std::string options :
       {"", "-s 1 1 1 ", "-s 2 ", "-o 0.5 0.5 ", "-t 0 0 0 -mm 0 1 ", "-clamp on ", "-imfchan r -bm 1.5 ",
        "-blendu off -blendv on -boost 2 -cc on -texres 512 -type sphere ", "-S 1 -O 0 1 "})
    EXPECT_EQ(only_material("map_Kd " + options + "wood.png").map(MtlMap::diffuse), "wood.png") << options;
}

TEST(Mtl, FileNamesMayHaveBlanksAndBackslashes) {
  EXPECT_EQ(only_material("map_Kd  my wood #2.png \t").map(MtlMap::diffuse), "my wood #2.png");
  EXPECT_EQ(only_material("map_Kd -s 1 1 1 2 b.png").map(MtlMap::diffuse), "2 b.png");
  EXPECT_EQ(only_material("map_Kd \" my wood.png \"").map(MtlMap::diffuse), "my wood.png");
  EXPECT_EQ(only_material("map_Kd .\\maps\\wood.png").map(MtlMap::diffuse), "./maps/wood.png");
  EXPECT_EQ(only_material("map_Kd -wood.png").map(MtlMap::diffuse), "-wood.png");
  EXPECT_EQ(only_material("map_Kd -s 3").map(MtlMap::diffuse), "3");
}

TEST(Mtl, EachKeywordHasItsMap) {
  const MtlMaterial material = only_material(
      "map_kd a\nMAP_KE b\nnorm c\nbump d\nmap_Pr -imfchan g e\nmap_Pm -imfchan b f\nmap_d g\nmap_Ks h\nrefl i");
  const std::array<std::string, mtl_map_count> expected{"a", "b", "c", "d", "e", "f", "g"};
  EXPECT_EQ(material.maps, expected);
}

TEST(Mtl, MaterialNamesMayHaveBlanksOrBeEmpty) {
  const auto materials = parse_mtl("Kd 9\nnewmtl  Hard Shiny #2  \nNs 1\nnewmtl\nNs 2\nnewmtl Terraind\xe4k");
  ASSERT_EQ(materials.size(), 3U);
  EXPECT_EQ(materials[0].name, "Hard Shiny #2");
  EXPECT_EQ(materials[1].name, "");
  EXPECT_EQ(materials[2].name, "Terraind\xe4k");
}

TEST(Mtl, LineEndsAndAByteOrderMarkAreIgnored) {
  const auto expected = parse_mtl("newmtl a b\nKd 1 0 0\nmap_Kd x y.png\n");
  EXPECT_EQ(parse_mtl("\xef\xbb\xbfnewmtl a b\r\n# c\r\n  Kd 1 \\\r\n 0 0\r\n\tmap_Kd x y.png"), expected);
}

TEST(Mtl, DamageIsRefusedWithItsLine) {
  EXPECT_THAT(mtl_complaint("newmtl a\nKd 1 x 0"), HasSubstr("line 2: expected a finite number, found 'x'"));
  EXPECT_THAT(mtl_complaint("newmtl a\nd nan"), HasSubstr("line 2: expected a finite number, found 'nan'"));
  EXPECT_THAT(mtl_complaint("newmtl a\nKe 1 inf 0"), HasSubstr("found 'inf'"));
  EXPECT_THAT(mtl_complaint("newmtl a\nPr"), HasSubstr("found the end of the line"));
  EXPECT_THAT(mtl_complaint(std::string_view("newmtl a\0", 9)), HasSubstr("not a text"));
  EXPECT_THAT(mtl_complaint("\xff\xfen"), HasSubstr("UTF-16"));
  std::string many;
  for (size_t i = 0; i <= most_materials; ++i) many += "newmtl a\n";
  EXPECT_THAT(mtl_complaint(many), HasSubstr("line 65537: there are more than 65536 materials"));
}

TEST(Mtl, MaterialsRoundTrip) {
  MtlMaterial full{.name = "a b",
                   .diffuse = Color{0.1, 1.0 / 3, 1},
                   .emissive = Color{12, 0, 1e-9},
                   .opacity = 0.5,
                   .shininess = 3,
                   .roughness = 0.7,
                   .metallic = 0.2};
  for (size_t i = 0; i < mtl_map_count; ++i) full.maps.at(i) = "map " + std::to_string(i) + ".png";
  const std::vector<MtlMaterial> materials{full, {.name = ""}, {.name = "c"}};
  EXPECT_EQ(parse_mtl(format_mtl(materials)), materials);
  EXPECT_THAT(format_mtl(materials), HasSubstr("\nmap_Pr -imfchan g map 4.png\nmap_Pm -imfchan b map 5.png\n"));
}

}  // namespace
}  // namespace papilio::client
