// The colours of all pictures, and of the report's page, whose build reads this file: one result looks the same in both.
#pragma once

#include <array>
#include <cstdint>

namespace millscope::picture {

/// viridis (Smith, van der Walt and Firing 2015), and cool to warm through light grey (Moreland, Diverging Color Maps for Scientific
/// Visualization, 2009): 0xRRGGBB, every eighth entry of the published tables; straight lines between them differ from the tables by less
/// than 3/255.
constexpr std::array<std::uint32_t, 33> kSequential{
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453781, 0x424086, 0x3e4989, 0x3b528b, 0x375b8d, 0x33638d,
    0x2f6b8e, 0x2c728e, 0x297a8e, 0x26828e, 0x23898e, 0x21918c, 0x1f988b, 0x1fa088, 0x22a785, 0x28ae80, 0x32b67a,
    0x3fbc73, 0x4ec36b, 0x5ec962, 0x70cf57, 0x84d44b, 0x98d83e, 0xaddc30, 0xc2df23, 0xd8e219, 0xece51b, 0xfde725};
constexpr std::array<std::uint32_t, 33> kDiverging{0x3b4cc0, 0x445acc, 0x4e68d8, 0x5875e1, 0x6282ea, 0x6c8ff1, 0x779af7, 0x82a6fb, 0x8db0fe,
                                                   0x98b9ff, 0xa3c2fe, 0xaec9fc, 0xb9d0f9, 0xc3d5f4, 0xccd9ed, 0xd5dbe5, 0xdddcdc, 0xe5d8d1,
                                                   0xecd3c5, 0xf1ccb8, 0xf5c4ac, 0xf7ba9f, 0xf7b093, 0xf6a586, 0xf4987a, 0xf08b6e, 0xeb7d62,
                                                   0xe46e56, 0xdd5f4b, 0xd44e41, 0xca3b37, 0xbe242e, 0xb40426};

/// Okabe and Ito 2008 without their yellow, which is lost on white, and their black, which is lost on a dark screen; brown and grey for
/// them.
constexpr std::array<std::uint32_t, 8> kDistinct{0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7, 0xe69f00, 0x56b4e9, 0x8a6d3b, 0x7f7f7f};

}  // namespace millscope::picture
