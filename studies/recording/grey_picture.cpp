#include "studies/recording/grey_picture.hpp"

#include <stb/stb_image.h>

#include <memory>

namespace millscope::recording {

std::optional<GreyPicture> read_grey_picture(const std::filesystem::path& file) {
  GreyPicture picture;
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(stbi_load(file.c_str(), &picture.width, &picture.height, &channels, 1),
                                                                    stbi_image_free);
  if (!pixels) return std::nullopt;
  picture.pixels.assign(pixels.get(), pixels.get() + static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  return picture;
}

}  // namespace millscope::recording
