// The implementations of stb's headers.
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_BMP  // libraries and readers of our own decode the other formats
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image.h>
#include <stb_image_write.h>
