// The same lookups by OpenImageIO's texture system, bilinear, in level 0.
#include "bench/images/Lookups.h"

#include <OpenImageIO/texture.h>

int main(int, char **arguments) {
  OIIO::TextureSystem *system = OIIO::TextureSystem::create(false);
  system->attribute("autotile", 64);
  system->attribute("automip", 0);
  OIIO::ustring file(arguments[1]);
  OIIO::TextureSystem::Perthread *thread = system->get_perthread_info();
  OIIO::TextureSystem::TextureHandle *handle = system->get_texture_handle(file, thread);
  OIIO::TextureOpt options;
  options.swrap = options.twrap = OIIO::TextureOpt::WrapPeriodic;
  options.interpmode = OIIO::TextureOpt::InterpBilinear;
  options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
  measure([&](float u, float v, float *sum) {
    float color[4];
    system->texture(handle, thread, options, u, v, 0, 0, 0, 0, 3, color);
    for (int i = 0; i < 3; ++i)
      sum[i] += color[i];
  });
  OIIO::TextureSystem::destroy(system);
}
