// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/closed_forms_cases.h"

#include "tests/helpers/radiative_transfer.h"
#include "tests/statistical/closed_forms_expected.h"

namespace fogbow::testing {

namespace {

using Definitions = std::map<std::string, std::string>;

const Vec3 kRoomCamera(0.1, 0.1, 0.8), kRoomTarget(-0.1, -0.1, -1);
const Ball kGlass{Vec3(0.3, -0.4, -0.2), 0.35}, kMirror{Vec3(0.45, 0.5, -0.4), 0.25};
/// n² of the glass.
constexpr double kInGlass = 2.25;
using enum Sampler::Price;
constexpr const char* kSpecularFirst =
    "light: cannot connect to a pinhole past the specular vertex next to it";

Definitions with(Definitions a, const Definitions& b) {
  a.insert(b.begin(), b.end());
  return a;
}

auto everywhere(double value) {
  return [value](int w, int h) { return constant_pixels(w, h, RGB(value)); };
}
auto beside(std::vector<Ball> balls) {
  return [balls = std::move(balls)](int w, int h) {
    return View{kRoomCamera, kRoomTarget, Vec3(0, 1, 0), 90}.pixels_beside(w, h, RGB(1), balls);
  };
}
/// A function of the film's size and one thing more.
template <class Pixels, class Parameter>
auto of(Pixels pixels, Parameter parameter) {
  return [=](int w, int h) { return pixels(w, h, parameter); };
}
auto half_space(double albedo) {
  return [albedo](int w, int h) { return half_space_pixels(w, h, 60, albedo); };
}
auto slab(SlabSide side) {
  return [side](int w, int h) { return slab_pixels(w, h, 60, side); };
}
ExpectedPixels half_space_in_glass(int width, int height) {
  const PlaneLayer layer(0.9, 0, 256, {1}, critical_cosine(1.5));
  return constant_pixels(width, height, RGB(layer.reflected_under_glass(1.5)));
}

void add_half_spaces(std::vector<ClosedForm>& forms) {
  const char* name = "half-space";
  forms.push_back({"Chandrasekhar, albedo 0.5",
                   name,
                   {{"albedo", "0.5"}, {"half_width", "20"}, {"half_depth", "6"}},
                   half_space(0.5),
                   true,
                   {{"path", 30}, {"light", 2200}, {"bdpt", 60}, {"pssmlt", 150}, {"mlt", 600}},
                   ""});
  forms.push_back({"Chandrasekhar, albedo 0.9",
                   name,
                   {{"albedo", "0.9"}, {"half_width", "30"}, {"half_depth", "10"}},
                   half_space(0.9),
                   true,
                   {{"path", 12}, {"light", 4800, kCostly}, {"bdpt", 65}, {"pssmlt", 150}},
                   ""});
  forms.push_back({"Chandrasekhar, albedo 0.99",
                   name,
                   {{"albedo", "0.99"}, {"half_width", "60"}, {"half_depth", "30"}},
                   half_space(0.99),
                   true,
                   {{"path", 130}, {"pssmlt", 300, kLongOnly}},
                   "light and bdpt: a hundred scatterings make too long a computation"});
  forms.push_back({"Giovanelli",
                   "half-space-glass",
                   {},
                   half_space_in_glass,
                   true,
                   {{"path", 50}, {"bdpt", 310, kCostly}, {"pssmlt", 340, kCostly}},
                   kSpecularFirst});
}

void add_slabs(std::vector<ClosedForm>& forms) {
  const char* name = "slab-van-de-hulst";
  // The published values at normal incidence, by reciprocity for a narrow view; their digits and
  // the view's width leave 6e-5 of them open.
  const Definitions narrow{{"fov", "2"}, {"res", "2"}}, dark{{"camera", "0, 0, -12"}};
  const char* too_narrow = "light: hardly any light passes through so narrow a view";
  forms.push_back({"van de Hulst R",
                   name,
                   narrow,
                   everywhere(0.09739),
                   true,
                   {{"path", 140}, {"bdpt", 330}, {"pssmlt", 450}},
                   too_narrow});
  forms.push_back({"van de Hulst T",
                   name,
                   with(narrow, dark),
                   everywhere(0.66096),
                   true,
                   {{"path", 10}, {"bdpt", 22}, {"pssmlt", 140}},
                   too_narrow});
  forms.push_back(
      {"slab R",
       name,
       {{"half_width", "30"}, {"box", "29"}},
       slab(SlabSide::Lit),
       true,
       {{"path", 80}, {"light", 38000, kLongOnly}, {"bdpt", 180}, {"pssmlt", 440, kCostly}},
       ""});
  forms.push_back({"slab T",
                   name,
                   dark,
                   slab(SlabSide::Dark),
                   true,
                   {{"path", 10}, {"bdpt", 34}, {"pssmlt", 140}},
                   "light: the ballistic part comes from infinity straight to the pinhole"});
}

/// A room as a whole, and without the pixels that show balls: light tracing sees none of those, and
/// wants the near plane far away.
void add_room(std::vector<ClosedForm>& forms, const std::string& name, const std::string& scene,
              const Definitions& definitions, const std::vector<Ball>& balls,
              const std::vector<Sampler>& from_eye, const Sampler& light) {
  forms.push_back({name, scene, definitions, everywhere(1), true, from_eye, kSpecularFirst});
  forms.push_back({name + ", beside balls",
                   scene,
                   with(definitions, {{"near", "0.2"}}),
                   beside(balls),
                   true,
                   {light},
                   "path, bdpt, pssmlt: the whole picture is compared above"});
}

void add_enclosures(std::vector<ClosedForm>& forms) {
  const char* scene = "conservative-enclosure";
  add_room(forms, "enclosure", scene, {}, {kGlass}, {{"path", 12}, {"bdpt", 24}, {"pssmlt", 140}},
           {"light", 950});
  add_room(forms, "enclosure, fog in R and G", scene, {{"fog_sigma_t", "0.5, 0.8, 0"}}, {kGlass},
           {{"path", 40}, {"bdpt", 40}, {"pssmlt", 350}, {"mlt", 6000, kLongOnly}},
           {"light", 1900, kCostly});
  add_room(forms, "enclosure, smoke", scene, {{"cloud", "smoke"}}, {kGlass},
           {{"path", 12}, {"bdpt", 24}, {"pssmlt", 140}, {"mlt", 6000, kLongOnly}}, {"light", 950});
  forms.push_back({"enclosure from inside glass",
                   scene,
                   {{"camera", "0.3, -0.4, -0.1"}, {"medium", "milk"}},
                   everywhere(kInGlass),
                   true,
                   {{"path", 40}, {"bdpt", 14}, {"pssmlt", 140}},
                   kSpecularFirst});
}

void add_cavities(std::vector<ClosedForm>& forms) {
  const char* scene = "isothermal-cavity";
  const std::vector<Ball> balls{kGlass, kMirror};
  add_room(forms, "cavity", scene, {}, balls, {{"path", 5}, {"bdpt", 10}, {"pssmlt", 140}},
           {"light", 420});
  add_room(forms, "cavity, fog in R and G", scene,
           {{"fog_sigma_t", "0.5, 0.8, 0"}, {"fog_emission", "0.2, 0.4, 0"}}, balls,
           {{"path", 34}, {"bdpt", 80}, {"pssmlt", 1000, kLongOnly}}, {"light", 600});
  add_room(forms, "cavity, cloud only emits", scene,
           {{"cloud_albedo", "0"}, {"cloud_emission", "1"}}, balls,
           {{"path", 5}, {"bdpt", 13}, {"pssmlt", 140}, {"mlt", 6000, kLongOnly}}, {"light", 400});
  for (const char* cloud : {"smoke", "bricks"})
    add_room(forms, std::string("cavity, ") + cloud, scene, {{"cloud", cloud}}, balls,
             {{"path", 5}, {"bdpt", 13}, {"pssmlt", 140}, {"mlt", 6000, kLongOnly}},
             {"light", 420});
  forms.push_back({"cavity from inside glass",
                   scene,
                   {{"camera", "0.3, -0.4, -0.1"}, {"medium", "tinted"}},
                   everywhere(kInGlass),
                   true,
                   {{"path", 5}, {"bdpt", 12}, {"pssmlt", 140}},
                   kSpecularFirst});
}

void add_point_lights(std::vector<ClosedForm>& forms) {
  const char* no_caustic = "path: cannot connect to a point light past a specular vertex";
  const char* name = "plane-mirror";
  forms.push_back({"floor without its mirror",
                   name,
                   {{"max_depth", "2"}},
                   of(plane_mirror_pixels, false),
                   false,
                   {{"path", 5}, {"light", 130}, {"bdpt", 5}, {"pssmlt", 140}},
                   ""});
  forms.push_back({"plane mirror",
                   name,
                   {},
                   of(plane_mirror_pixels, true),
                   false,
                   {{"light", 80}, {"bdpt", 18}, {"pssmlt", 140}},
                   no_caustic});
  forms.push_back({"shadow of a ball",
                   "ball-caustic",
                   {{"max_depth", "2"}, {"res", "8"}},
                   of(ball_caustic_pixels, false),
                   false,
                   {{"path", 38}, {"light", 700}, {"bdpt", 30}, {"pssmlt", 150}},
                   ""});
  forms.push_back({"ball caustic",
                   "ball-caustic",
                   {{"res", "8"}},
                   of(ball_caustic_pixels, true),
                   false,
                   {{"light", 600}, {"bdpt", 600}, {"pssmlt", 1100}, {"mlt", 2000}},
                   no_caustic});
}

void add_airlight(std::vector<ClosedForm>& forms) {
  forms.push_back(
      {"airlight",
       "airlight",
       {},
       of(airlight_pixels, 0.01),
       false,
       {{"path", 14}, {"bdpt", 32}, {"pssmlt", 140}, {"mlt", 600}},
       "light: connects to scattering close to the pinhole, without a finite variance"});
  forms.push_back({"airlight, far near plane",
                   "airlight",
                   {{"near", "0.5"}},
                   of(airlight_pixels, 0.5),
                   false,
                   {{"path", 18}, {"light", 9500, kCostly}, {"bdpt", 60}, {"pssmlt", 140}},
                   ""});
}

void add_interfaces(std::vector<ClosedForm>& forms) {
  forms.push_back({"Fresnel plate",
                   "fresnel-plate",
                   {},
                   fresnel_plate_pixels,
                   true,
                   {{"path", 5}, {"bdpt", 5}, {"pssmlt", 140}},
                   kSpecularFirst});
  for (const auto& [distribution, facets] :
       {std::pair("ggx", Facets::Ggx), {"beckmann", Facets::Beckmann}}) {
    const std::string name = std::string(" (") + distribution + ")";
    const Definitions distributed{{"distribution", distribution}};
    forms.push_back({"rough conductor" + name,
                     "rough-furnace",
                     with(distributed, {{"bsdf", "conductor"}}),
                     of(rough_conductor_pixels, facets),
                     false,
                     {{"path", 8}, {"light", 3500}, {"bdpt", 10}, {"pssmlt", 140}},
                     ""});
    forms.push_back({"rough dielectric" + name,
                     "rough-furnace",
                     with(distributed, {{"bsdf", "dielectric"}}),
                     of(rough_dielectric_pixels, facets),
                     false,
                     {{"path", 5}, {"light", 22000, kCostly}, {"bdpt", 5}, {"pssmlt", 140}},
                     ""});
  }
}

}  // namespace

const std::vector<ClosedForm>& closed_forms() {
  static const std::vector<ClosedForm> forms = [] {
    std::vector<ClosedForm> list;
    add_half_spaces(list);
    add_slabs(list);
    add_enclosures(list);
    add_cavities(list);
    add_point_lights(list);
    add_airlight(list);
    add_interfaces(list);
    return list;
  }();
  return forms;
}

}  // namespace fogbow::testing
