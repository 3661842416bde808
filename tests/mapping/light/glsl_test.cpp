// The GLSL include, compiled by glslang to SPIR-V and run by Mesa's software OpenGL (llvmpipe)
// through EGL without a window system, against the C++ lookup.
#define GL_GLEXT_PROTOTYPES
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glcorearb.h>
#include <gtest/gtest.h>

#include <gonio/mapping/light/texture/light_texture.h>

#include "tests/support/light_cases.h"

#ifndef GONIO_LDT_SPIRV
#error "the SPIR-V file of tests/mapping/light/glsl/ldt.comp"
#endif

namespace gonio {
namespace {

using testing::rad;

constexpr int lookup = 0, plain_lights = 1, ldt_lights = 2;

/// An OpenGL 4.5 context of the software renderer; `error` says what is missing.
class Context {
 public:
  Context() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    display_ = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display_ == EGL_NO_DISPLAY || !eglInitialize(display_, nullptr, nullptr)) {
      error = "no EGL display without a window system (libegl-mesa0, libgl1-mesa-dri)";
      return;
    }
    eglBindAPI(EGL_OPENGL_API);
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
      error = "no OpenGL 4.5 (libgl1-mesa-dri)";
      return;
    }
    specialize = reinterpret_cast<PFNGLSPECIALIZESHADERARBPROC>(eglGetProcAddress("glSpecializeShaderARB"));
    GLint count = 0;
    glGetIntegerv(GL_NUM_EXTENSIONS, &count);
    bool spirv = false;
    for (GLint k = 0; k < count; ++k)
      spirv =
          spirv || std::string(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, static_cast<GLuint>(k)))) ==
                       "GL_ARB_gl_spirv";
    if (!spirv || specialize == nullptr) error = "the driver cannot load SPIR-V (GL_ARB_gl_spirv)";
  }
  ~Context() {
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    if (display_ != EGL_NO_DISPLAY) eglTerminate(display_);
  }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  std::string renderer() const { return reinterpret_cast<const char*>(glGetString(GL_RENDERER)); }

  std::string error;
  PFNGLSPECIALIZESHADERARBPROC specialize = nullptr;

 private:
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

class Glsl : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = std::make_unique<Context>(); }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_->error.empty()) GTEST_SKIP() << context_->error;
  }

  /// The program with its constants set; kept, since the driver takes long to compile one.
  static GLuint program(int mode, LightFilter filter, int lights) {
    static std::map<std::tuple<int, int, int>, GLuint> programs;
    GLuint& program = programs[{mode, static_cast<int>(filter), lights}];
    if (program == 0) program = make_program(mode, filter, lights);
    return program;
  }

  static GLuint make_program(int mode, LightFilter filter, int lights) {
    std::ifstream stream(GONIO_LDT_SPIRV, std::ios::binary);
    const std::vector<char> code((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    EXPECT_FALSE(code.empty()) << GONIO_LDT_SPIRV;
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    glShaderBinary(1, &shader, GL_SHADER_BINARY_FORMAT_SPIR_V_ARB, code.data(), static_cast<GLsizei>(code.size()));
    const GLuint index[] = {0, 1, 2};
    const GLuint value[] = {static_cast<GLuint>(mode), static_cast<GLuint>(filter), static_cast<GLuint>(lights)};
    context_->specialize(shader, "main", 3, index, value);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    GLint linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    char log[1000] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    EXPECT_TRUE(linked) << log;
    glDeleteShader(shader);
    return program;
  }

  struct Run {
    std::vector<float> result;
    double nanoseconds;  ///< per direction, the best of five
  };

  static Run run(const LightTexture& texture, int mode, int lights, const std::vector<Vec3<float>>& directions) {
    struct {
      float nadir[4], c0[4], c90[4];
      GLint size[4];
      float gamma[4];
    } parameters = {};
    for (int k = 0; k < 3; ++k) {
      parameters.nadir[k] = static_cast<float>(texture.frame().nadir[k]);
      parameters.c0[k] = static_cast<float>(texture.frame().c0[k]);
      parameters.c90[k] = static_cast<float>(texture.frame().c90[k]);
    }
    parameters.size[0] = texture.n_gamma(), parameters.size[1] = texture.m_c();
    parameters.size[2] = static_cast<GLint>(directions.size());
    parameters.gamma[0] = texture.gamma_from(), parameters.gamma[1] = texture.gamma_step();
    std::vector<float> padded;
    for (const Vec3<float>& d : directions) padded.insert(padded.end(), {d.x, d.y, d.z, 0.0f});

    GLuint buffers[3], image;
    glGenBuffers(3, buffers);
    const auto upload = [&](GLenum target, GLuint binding, std::size_t bytes, const void* data) {
      glBindBuffer(target, buffers[binding]);
      glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
      glBindBufferBase(target, binding, buffers[binding]);
    };
    upload(GL_SHADER_STORAGE_BUFFER, 0, padded.size() * 4, padded.data());
    upload(GL_SHADER_STORAGE_BUFFER, 1, directions.size() * 4, nullptr);
    upload(GL_UNIFORM_BUFFER, 2, sizeof parameters, &parameters);
    glGenTextures(1, &image);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, image);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, texture.width(), texture.m_c(), 0, GL_RED, GL_FLOAT,
                 texture.texels().data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);

    const GLuint compute = program(mode, texture.filter(), lights);
    glUseProgram(compute);
    Run run{std::vector<float>(directions.size()), 1e30};
    for (int k = 0; k < (mode == lookup ? 1 : 5); ++k) {
      // Timer queries of llvmpipe do not cover compute shaders.
      const auto start = std::chrono::steady_clock::now();
      glDispatchCompute(static_cast<GLuint>((directions.size() + 63) / 64), 1, 1);
      glMemoryBarrier(GL_ALL_BARRIER_BITS);
      glFinish();
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      run.nanoseconds = std::min(run.nanoseconds, seconds.count() * 1e9 / double(directions.size()));
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[1]);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(directions.size() * 4), run.result.data());
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    glDeleteTextures(1, &image);
    glDeleteBuffers(3, buffers);
    return run;
  }

  static std::vector<Vec3<float>> spread(int count) {
    std::vector<Vec3<float>> all;
    for (const Vec3<double>& w : testing::directions(count)) all.push_back(Vec3<float>(w));
    // The axes and their surroundings, where formulas break.
    for (float e : {0.0f, 1e-7f, -1e-7f, 1e-3f})
      for (int axis = 0; axis < 3; ++axis)
        for (float sign : {1.0f, -1.0f}) {
          Vec3<float> w{e, e, e};
          w[axis] = sign;
          all.push_back(glm::normalize(w));
        }
    return all;
  }

  static double largest_difference(const LightTexture& texture, const std::vector<Vec3<float>>& directions) {
    const Run gpu = run(texture, lookup, 1, directions);
    double largest = 0;
    for (std::size_t k = 0; k < directions.size(); ++k)
      largest = std::max(largest, std::abs(double(gpu.result[k]) - double(texture.lookup(directions[k]))));
    return largest;
  }

  static std::unique_ptr<Context> context_;
};

std::unique_ptr<Context> Glsl::context_;

constexpr const char* filter_names[] = {"bilinear", "Catmull-Rom", "Mitchell-Netravali", "B-spline"};

LightDiagram symmetric(LightSymmetry symmetry) {
  switch (symmetry) {
    case LightSymmetry::rotational:
      return testing::narrow_spot().diagram;
    case LightSymmetry::quadrant:
      return testing::tabulate(24, 36, pi<double>,
                               [](double c, double g) { return (2 + std::cos(2 * c) * std::sin(g)) * std::exp(-g); });
    case LightSymmetry::c0_c180:
      return testing::tabulate(24, 36, pi<double>,
                               [](double c, double g) { return (2 + std::cos(c) * std::sin(g)) * std::exp(-g); });
    case LightSymmetry::c90_c270:
      return testing::tabulate(24, 36, pi<double>,
                               [](double c, double g) { return (2 + std::sin(c) * std::sin(g)) * std::exp(-g); });
    case LightSymmetry::none:
      break;
  }
  return testing::asymmetric().diagram;
}

TEST_F(Glsl, EverySymmetryAndFilterAgreesWithTheLibrary) {
  std::printf("renderer: %s\n", context_->renderer().c_str());
  const auto directions = spread(100000);
  for (LightSymmetry symmetry : {LightSymmetry::none, LightSymmetry::rotational, LightSymmetry::c0_c180,
                                 LightSymmetry::c90_c270, LightSymmetry::quadrant}) {
    const LightDiagram diagram = symmetric(symmetry);
    EXPECT_EQ(find_symmetry(diagram), symmetry);
    for (int filter = 0; filter < 4; ++filter) {
      const double difference = largest_difference(LightTexture(diagram, static_cast<LightFilter>(filter)), directions);
      std::printf("%-24s %-20s largest difference %.1e of I_max\n", to_string(symmetry), filter_names[filter],
                  difference);
      EXPECT_LT(difference, 1e-5);
    }
  }
}

TEST_F(Glsl, HemispheresAndTurnedLuminairesAgree) {
  const auto directions = spread(100000);
  LightDiagram turned = testing::asymmetric().diagram;
  turned.frame.nadir = glm::normalize(Vec3<double>{1, 2, -1});
  turned.frame.c0 = glm::normalize(glm::cross(turned.frame.nadir, {0, 1, 0}));
  turned.frame.c90 = glm::cross(turned.frame.c0, turned.frame.nadir);
  for (const LightDiagram& diagram : {testing::lambertian().diagram, testing::uplight().diagram, turned})
    for (int filter = 0; filter < 4; ++filter)
      EXPECT_LT(largest_difference(LightTexture(diagram, static_cast<LightFilter>(filter)), directions), 1e-5);
}

// One texture, two filters: differences are seen.
TEST_F(Glsl, TheComparisonCanFail) {
  const auto directions = spread(1000);
  const LightDiagram diagram = testing::asymmetric().diagram;
  const Run gpu = run(LightTexture(diagram, LightFilter::catmull_rom), lookup, 1, directions);
  const LightTexture other(diagram, LightFilter::bilinear);
  double largest = 0;
  for (std::size_t k = 0; k < directions.size(); ++k)
    largest = std::max(largest, std::abs(double(gpu.result[k]) - double(other.lookup(directions[k]))));
  EXPECT_GT(largest, 1e-3);
}

TEST_F(Glsl, AsymmetricLuminairePointsTheSameWay) {
  const auto directions = spread(100000);
  const Run gpu = run(LightTexture(testing::asymmetric().diagram, LightFilter::bspline), lookup, 1, directions);
  const auto best = std::max_element(gpu.result.begin(), gpu.result.end()) - gpu.result.begin();
  EXPECT_LT(glm::length(Vec3<double>(directions[static_cast<std::size_t>(best)]) - testing::asymmetric_peak()), rad(1));
}

TEST_F(Glsl, Lambertian1000Lumens) {
  const auto directions = spread(200000);
  for (int filter = 0; filter < 4; ++filter) {
    const LightTexture texture(testing::lambertian().diagram, static_cast<LightFilter>(filter));
    const Run gpu = run(texture, lookup, 1, directions);
    double sum = 0;
    for (std::size_t k = 0; k < 200000; ++k) sum += double(gpu.result[k]) * texture.max_cd() * 4 * pi<double> / 200000;
    EXPECT_NEAR(sum, 1000, 0.1);
    const Run straight = run(texture, lookup, 1, {{0, 0, -1}});
    EXPECT_NEAR(double(straight.result[0]) * texture.max_cd(), 1000 / pi<double>, 0.02);
  }
}

TEST_F(Glsl, PhotometricFiles) {
  const auto files = testing::photometric_files();
  if (files.empty()) GTEST_SKIP() << "GONIO_TEST_DATA is not set";
  const auto directions = spread(100000);
  double worst[4] = {};
  for (const auto& path : files) {
    const LightDiagram diagram = load_light(path).diagram;
    for (int filter = 0; filter < 4; ++filter) {
      const double difference = largest_difference(LightTexture(diagram, static_cast<LightFilter>(filter)), directions);
      worst[filter] = std::max(worst[filter], difference);
      // A step of the intensity that is narrower than a float can place a direction (type B, where
      // the measured sector ends) may fall on either side.
      if (path.filename() != "test.ies") {
        EXPECT_LT(difference, 1e-5) << path << " " << filter_names[filter];
      }
    }
  }
  for (int filter = 0; filter < 4; ++filter)
    std::printf("%-20s largest difference of all files %.1e of I_max\n", filter_names[filter], worst[filter]);
}

// Table 1 of Wallner (2008) as cost of the lighting alone: shading a point by 1, 4 and 7 lights.
TEST_F(Glsl, CostOverPlainPointLights) {
  const auto directions = spread(200000);
  std::printf("renderer: %s; ns per shaded point, and its multiple of the plain point light's\n",
              context_->renderer().c_str());
  std::printf("lights  plain   rotational: bilinear  bicubic      none: bilinear  bicubic\n");
  for (int lights : {1, 4, 7}) {
    const LightTexture any(testing::asymmetric().diagram, LightFilter::bilinear);
    const double plain = run(any, plain_lights, lights, directions).nanoseconds;
    std::printf("%4d  %7.2f ", lights, plain);
    for (LightSymmetry symmetry : {LightSymmetry::rotational, LightSymmetry::none})
      for (LightFilter filter : {LightFilter::bilinear, LightFilter::bspline}) {
        const Run lit = run(LightTexture(symmetric(symmetry), filter), ldt_lights, lights, directions);
        std::printf("  %8.2f (%.1fx)", lit.nanoseconds, lit.nanoseconds / plain);
        EXPECT_TRUE(
            std::all_of(lit.result.begin(), lit.result.end(), [](float v) { return std::isfinite(v) && v >= 0; }));
      }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace gonio
