// What the page says of itself to those who show a preview of it. They take whole addresses only.

/**
 * @param {string} html the page, with an image that is named by its file
 * @param {string | undefined} address where the page will stand, with a slash at its end; without it nothing is named
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
