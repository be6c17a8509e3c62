// Metadata of the page for link previews, which require absolute URLs.

/**
 * @param {string} html the page, with an image given by its file name
 * @param {string | undefined} address address of the page with a slash at the end; without it, the image is removed
 */
export function addressed(html, address) {
  const image = /\n( *)<meta property="og:image" content="(.*)" \/>/;
  return html.replace(image, (_, space, file) => {
    if (!address) return "";
    const tags = [
      `<link rel="canonical" href="${address}" />`,
      `<meta property="og:url" content="${address}" />`,
      `<meta property="og:image" content="${address}${file}" />`,
    ];
    return tags.map((tag) => `\n${space}${tag}`).join("");
  });
}
